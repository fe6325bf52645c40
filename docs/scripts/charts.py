# SPDX-License-Identifier: Apache-2.0
"""Plain SVG charts for the pages: lines on two logarithmic axes, and bars of ratios on one."""
import html
import math

COLOURS = ["#207040", "#3060b0", "#c03030", "#d08a20", "#704090", "#405060"]


def fitted_exponent(points):
    """b of the least-squares fit y = a x^b; None for fewer than two different x."""
    logs = [(math.log(x), math.log(y)) for x, y in points if x > 0 and y > 0]
    if len({x for x, _ in logs}) < 2:
        return None
    mean_x, mean_y = (sum(values) / len(logs) for values in zip(*logs))
    return sum((x - mean_x) * (y - mean_y) for x, y in logs) / sum((x - mean_x) ** 2 for x, _ in logs)


def plain(value):
    return f"{value:,.0f}" if value >= 1 else f"{value:g}"


def text(x, y, words, anchor="start", size=12, colour="#202020"):
    return (f'<text x="{x:.1f}" y="{y:.1f}" font-size="{size}" text-anchor="{anchor}" fill="{colour}">'
            f'{html.escape(words)}</text>')


def line(x0, y0, x1, y1, colour="#d8dce4", width=1):
    return (f'<line x1="{x0:.1f}" y1="{y0:.1f}" x2="{x1:.1f}" y2="{y1:.1f}" stroke="{colour}" '
            f'stroke-width="{width}"/>')


def write_svg(path, width, height, parts):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" '
                    f'font-family="sans-serif">\n<rect width="{width}" height="{height}" fill="white"/>\n' +
                    "\n".join(parts) + "\n</svg>\n")


def decades(values):
    """Powers of ten from below the least value to above the greatest."""
    low, high = math.floor(math.log10(min(values))), math.ceil(math.log10(max(values)))
    return [10.0 ** power for power in range(low, max(high, low + 1) + 1)]


def log_chart(path, title, x_name, y_name, series, x_ticks):
    """`series`: name -> [(x, y)]. The x axis is marked at `x_ticks`."""
    series = {name: points for name, points in series.items() if points}
    if not series:
        return
    width, height, left, right, top, bottom = 860, 420, 70, 250, 40, 50
    xs = [*x_ticks, *(x for points in series.values() for x, _ in points)]
    low_x, high_x = math.log(min(xs)) - 0.1, math.log(max(xs)) + 0.1
    y_ticks = decades([y for points in series.values() for _, y in points])
    low_y, high_y = math.log(y_ticks[0]), math.log(y_ticks[-1])

    def at(x, y):
        return (left + (math.log(x) - low_x) / (high_x - low_x) * (width - left - right),
                height - bottom - (math.log(y) - low_y) / (high_y - low_y) * (height - top - bottom))

    parts = [text(left, 24, title, size=14)]
    for y in y_ticks:
        parts += [line(left, at(xs[0], y)[1], width - right, at(xs[0], y)[1]),
                  text(left - 8, at(xs[0], y)[1] + 4, plain(y), "end")]
    for x in x_ticks:
        parts += [line(at(x, y_ticks[0])[0], top, at(x, y_ticks[0])[0], height - bottom),
                  text(at(x, y_ticks[0])[0], height - bottom + 18, plain(x), "middle")]
    parts += [text((left + width - right) / 2, height - 10, x_name, "middle"), text(8, 24, y_name)]
    for row, (name, points) in enumerate(series.items()):
        colour = COLOURS[row % len(COLOURS)]
        ends = [at(x, y) for x, y in sorted(points)]
        parts.append(f'<polyline points="{" ".join("%.1f,%.1f" % end for end in ends)}" fill="none" '
                     f'stroke="{colour}" stroke-width="2"/>')
        parts += [f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3" fill="{colour}"/>' for x, y in ends]
        parts.append(text(width - right + 14, top + 16 + 20 * row, name, colour=colour))
    write_svg(path, width, height, parts)


def ratio_bars(path, title, ratios, limit):
    """`ratios`: name -> value, drawn on a logarithmic axis from 1; `limit` is marked."""
    if not ratios:
        return
    row_height, left, right, top = 18, 190, 60, 44
    width, height = 860, top + row_height * len(ratios) + 30
    low = math.log(min(*ratios.values(), limit, 1.0)) - 0.1
    high = math.log(max(*ratios.values(), limit, 1.0)) + 0.1

    def at(value):
        return left + (math.log(value) - low) / (high - low) * (width - left - right)

    parts = [text(12, 24, title, size=14)]
    for row, (name, value) in enumerate(ratios.items()):
        y = top + row_height * row
        colour = COLOURS[0] if value <= limit else COLOURS[2]
        start, end = sorted((at(1.0), at(value)))
        parts += [text(left - 8, y + 12, name, "end", 11),
                  f'<rect x="{start:.1f}" y="{y + 2}" width="{max(end - start, 0.5):.1f}" '
                  f'height="{row_height - 5}" fill="{colour}"/>',
                  text(end + 5, y + 12, f"{value:.2f}", size=11)]
    for value, name in ((1.0, "1"), (limit, f"{limit:g}")):
        parts += [line(at(value), top, at(value), height - 22, "#404858"),
                  text(at(value), height - 8, name, "middle", 11)]
    write_svg(path, width, height, parts)
