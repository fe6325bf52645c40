// SPDX-License-Identifier: Apache-2.0

// The only place where the coordinates of files become float32. Each is rounded once: a text goes
// to the nearest float straight from its decimals, and where the object is moved, origin and unit
// are applied in doubles before the one rounding. So the mesh does not depend on the way that a
// coordinate takes, and the largest rounding can be reported. Whoever chooses an origin has to see
// all coordinates before any is rounded; that is the first look, which has no limit of 1e18 (that
// of float32 remains).

#include "io/coordinates.h"

#include "vdb_shell/mesh/check_mesh.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>

namespace vdb_shell
{
namespace
{

std::string digits_of(double value)
{
    std::array<char, 32> digits{};
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
    return {digits.data(), end};
}

/// The number that the word stands for, to the precision of double: what the rounding of the float
/// is measured against. Precondition: parse_coordinate took the word.
double exact_value(std::string_view word)
{
    // std::from_chars takes no plus sign.
    if (word[0] == '+')
        word.remove_prefix(1);
    double value = 0;
    std::from_chars(word.data(), word.data() + word.size(), value);
    return value;
}

} // namespace

Coordinates Coordinates::first_look()
{
    Coordinates coordinates;
    coordinates.limited_ = false;
    return coordinates;
}

Coordinates::Coordinates(const Placement& placement) : placement_(placement)
{
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    box_ = {openvdb::Vec3d(kInfinity), openvdb::Vec3d(-kInfinity)};
}

void Coordinates::see(double exact, int axis)
{
    box_.low[axis] = std::min(box_.low[axis], exact);
    box_.high[axis] = std::max(box_.high[axis], exact);
}

// The square of a larger coordinate would not be finite in float32, so the stages that square
// lengths could not work with it. A first look may see any size: the unit is chosen after it.
void Coordinates::require_limit(const std::string& name, const Place& place, double exact,
                                double value) const
{
    if (limited_ && std::abs(value) > kLargestCoordinate)
        refuse(name, place.text() + ": the coordinate " + digits_of(exact) +
                         " is over the limit of " + digits_of(kLargestCoordinate) +
                         "; --rescale reads the object in a larger unit");
}

float Coordinates::placed(const std::string& name, const Place& place, double exact, int axis)
{
    const double local = (exact - placement_.origin[axis]) / placement_.unit;
    // In double both steps are nearly exact, so that only the last one rounds.
    const float value = checked_coordinate(name, place, local);
    require_limit(name, place, exact, value);
    largest_rounding_ = std::max(largest_rounding_, std::abs(local - double(value)));
    return value;
}

float Coordinates::from_text(const std::string& name, const Place& place, std::string_view word,
                             int axis)
{
    // Straight from the decimals: by way of double it would be rounded twice, which can end at the
    // wrong one of two neighbours where the double lies just halfway between them.
    const float nearest = parse_coordinate(name, place, word);
    const double exact = exact_value(word);
    see(exact, axis);
    if (placement_.moves())
        return placed(name, place, exact, axis);
    require_limit(name, place, exact, nearest);
    // The double is itself rounded, but 2^29 times finer than the float.
    largest_rounding_ = std::max(largest_rounding_, std::abs(exact - double(nearest)));
    return nearest;
}

float Coordinates::from_number(const std::string& name, const Place& place, double value, int axis)
{
    checked_coordinate(name, place, value);
    see(value, axis);
    return placed(name, place, value, axis);
}

} // namespace vdb_shell
