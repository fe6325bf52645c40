// SPDX-License-Identifier: Apache-2.0

// Groups of numbers for kernels (core/simd.h). Read once for each target: Highway's own guard.
#if defined(VDB_SHELL_CORE_SIMD_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VDB_SHELL_CORE_SIMD_INL_H
#undef VDB_SHELL_CORE_SIMD_INL_H
#else
#define VDB_SHELL_CORE_SIMD_INL_H
#endif

#include "core/simd.h"

#include <array>
#include <cstdint>
#include <type_traits>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace vdb_shell::simd::HWY_NAMESPACE
{

namespace hn = hwy::HWY_NAMESPACE;

template <class T, std::size_t N> struct Group;
template <class T, std::size_t N> struct Truths;

/// What a group, or truths about one, consists of where the processor's vectors are too short.
template <class Half> struct Halves {
    Half low, high;
};

/// Whether N lanes fit into one vector of the target.
template <class T, std::size_t N>
inline constexpr bool kOneVector = hn::MaxLanes(hn::CappedTag<T, N>()) == N;

/// A truth for each lane.
template <class T, std::size_t N> struct Truths {
    static constexpr bool kWhole = kOneVector<T, N>;
    using Tag = hn::CappedTag<T, N>;
    using Half = Truths<T, N / 2>;
    std::conditional_t<kWhole, hn::Mask<Tag>, Halves<Half>> m;

    friend HWY_INLINE Truths operator&(Truths a, Truths b)
    {
        if constexpr (kWhole)
            return {hn::And(a.m, b.m)};
        else
            return {{a.m.low & b.m.low, a.m.high & b.m.high}};
    }
    friend HWY_INLINE Truths operator|(Truths a, Truths b)
    {
        if constexpr (kWhole)
            return {hn::Or(a.m, b.m)};
        else
            return {{a.m.low | b.m.low, a.m.high | b.m.high}};
    }
    /// A bit for each lane that is true, the first lane's the lowest.
    friend HWY_INLINE unsigned bits_of(Truths a)
    {
        if constexpr (kWhole) {
            std::uint8_t bits[8]; // one is written
            hn::StoreMaskBits(Tag(), a.m, bits);
            return bits[0];
        } else {
            return bits_of(a.m.low) | bits_of(a.m.high) << (N / 2);
        }
    }
};

/// N numbers: a vector of the target, or two groups of half as many.
template <class T, std::size_t N> struct Group {
    static constexpr bool kWhole = kOneVector<T, N>;
    using Tag = hn::CappedTag<T, N>;
    using Half = Group<T, N / 2>;
    using Vector = std::conditional_t<kWhole, hn::Vec<Tag>, Halves<Half>>;
    using Truth = Truths<T, N>;
    Vector v;

    // By default, so that it is trivial: GCC compiles what it makes itself for the baseline.
    Group() = default;
    HWY_INLINE explicit Group(Vector of) : v(of) {}
    /// The same number in each lane.
    HWY_INLINE Group(T x)
    {
        if constexpr (kWhole)
            v = hn::Set(Tag(), x);
        else
            v = {Half(x), Half(x)};
    }
    HWY_INLINE Group(Half low, Half high)
    {
#if HWY_TARGET == HWY_SCALAR // which has no vectors to combine
        v = {low, high};
#else
        if constexpr (kWhole)
            v = hn::Combine(Tag(), high.v, low.v);
        else
            v = {low, high};
#endif
    }
    /// From and to memory of any alignment.
    static HWY_INLINE Group load(const T* from)
    {
        if constexpr (kWhole)
            return Group(hn::LoadU(Tag(), from));
        else
            return {Half::load(from), Half::load(from + N / 2)};
    }
    friend HWY_INLINE void store(Group a, T* to)
    {
        if constexpr (kWhole)
            hn::StoreU(a.v, Tag(), to);
        else
            store(a.v.low, to), store(a.v.high, to + N / 2);
    }
    HWY_INLINE Half low() const
    {
        if constexpr (kWhole)
            return Half(hn::LowerHalf(v));
        else
            return v.low;
    }
    HWY_INLINE Half high() const
    {
#if HWY_TARGET == HWY_SCALAR
        return v.high;
#else
        if constexpr (kWhole)
            return Half(hn::UpperHalf(hn::Half<Tag>(), v));
        else
            return v.high;
#endif
    }

    friend HWY_INLINE Group operator+(Group a, Group b)
    {
        if constexpr (kWhole)
            return Group(hn::Add(a.v, b.v));
        else
            return {a.v.low + b.v.low, a.v.high + b.v.high};
    }
    friend HWY_INLINE Group operator-(Group a, Group b)
    {
        if constexpr (kWhole)
            return Group(hn::Sub(a.v, b.v));
        else
            return {a.v.low - b.v.low, a.v.high - b.v.high};
    }
    friend HWY_INLINE Group operator*(Group a, Group b)
    {
        if constexpr (kWhole)
            return Group(hn::Mul(a.v, b.v));
        else
            return {a.v.low * b.v.low, a.v.high * b.v.high};
    }
    friend HWY_INLINE Group operator/(Group a, Group b)
    {
        if constexpr (kWhole)
            return Group(hn::Div(a.v, b.v));
        else
            return {a.v.low / b.v.low, a.v.high / b.v.high};
    }
    friend HWY_INLINE Group operator-(Group a)
    {
        if constexpr (kWhole)
            return Group(hn::Neg(a.v));
        else
            return {-a.v.low, -a.v.high};
    }
    friend HWY_INLINE Group& operator+=(Group& a, Group b)
    {
        return a = a + b;
    }
    friend HWY_INLINE Group& operator-=(Group& a, Group b)
    {
        return a = a - b;
    }
    friend HWY_INLINE Group& operator*=(Group& a, Group b)
    {
        return a = a * b;
    }

    friend HWY_INLINE Truth operator<(Group a, Group b)
    {
        if constexpr (kWhole)
            return {hn::Lt(a.v, b.v)};
        else
            return {{a.v.low < b.v.low, a.v.high < b.v.high}};
    }
    friend HWY_INLINE Truth operator<=(Group a, Group b)
    {
        if constexpr (kWhole)
            return {hn::Le(a.v, b.v)};
        else
            return {{a.v.low <= b.v.low, a.v.high <= b.v.high}};
    }
    friend HWY_INLINE Truth operator>(Group a, Group b)
    {
        return b < a;
    }
    friend HWY_INLINE Truth operator>=(Group a, Group b)
    {
        return b <= a;
    }

    friend HWY_INLINE Group select(Truth truth, Group yes, Group no)
    {
        if constexpr (kWhole)
            return Group(hn::IfThenElse(truth.m, yes.v, no.v));
        else
            return {select(truth.m.low, yes.v.low, no.v.low),
                    select(truth.m.high, yes.v.high, no.v.high)};
    }
    /// a < b ? a : b, also of zeros and of what is not a number: Highway leaves to the target which
    /// of equal ones its minimum is.
    friend HWY_INLINE Group lesser(Group a, Group b)
    {
#if HWY_TARGET == HWY_SSE4 || HWY_TARGET == HWY_AVX2
        if constexpr (kWhole)
            return Group(hn::Min(a.v, b.v)); // one instruction, and just that
        else
            return {lesser(a.v.low, b.v.low), lesser(a.v.high, b.v.high)};
#else
        return select(a < b, a, b);
#endif
    }
    /// a > b ? a : b.
    friend HWY_INLINE Group greater(Group a, Group b)
    {
#if HWY_TARGET == HWY_SSE4 || HWY_TARGET == HWY_AVX2
        if constexpr (kWhole)
            return Group(hn::Max(a.v, b.v));
        else
            return {greater(a.v.low, b.v.low), greater(a.v.high, b.v.high)};
#else
        return select(b < a, a, b);
#endif
    }
    friend HWY_INLINE Group absolute(Group a)
    {
        if constexpr (kWhole)
            return Group(hn::Abs(a.v));
        else
            return {absolute(a.v.low), absolute(a.v.high)};
    }
    friend HWY_INLINE Group square_root(Group a)
    {
        if constexpr (kWhole)
            return Group(hn::Sqrt(a.v));
        else
            return {square_root(a.v.low), square_root(a.v.high)};
    }
    friend HWY_INLINE Group rounded_up(Group a)
    {
        if constexpr (kWhole)
            return Group(hn::Ceil(a.v));
        else
            return {rounded_up(a.v.low), rounded_up(a.v.high)};
    }
    friend HWY_INLINE Group rounded_down(Group a)
    {
        if constexpr (kWhole)
            return Group(hn::Floor(a.v));
        else
            return {rounded_down(a.v.low), rounded_down(a.v.high)};
    }
};

using Floats = Group<float, kLanes>;
using Doubles = Group<double, kDoubleLanes>;
using Integers = Group<std::int32_t, kLanes>;
using FloatPoint = std::array<Floats, 3>;   ///< by axis
using DoublePoint = std::array<Doubles, 3>; ///< by axis

template <class Lanes>
HWY_INLINE Lanes dot(const std::array<Lanes, 3>& a, const std::array<Lanes, 3>& b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
template <class Lanes>
HWY_INLINE std::array<Lanes, 3> cross(const std::array<Lanes, 3>& a, const std::array<Lanes, 3>& b)
{
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

template <class T, std::size_t N> HWY_INLINE void lower_to(Group<T, N>& least, Group<T, N> other)
{
    least = lesser(other, least);
}
template <class T, std::size_t N> HWY_INLINE void raise_to(Group<T, N>& most, Group<T, N> other)
{
    most = greater(other, most);
}
template <class T, std::size_t N>
HWY_INLINE Group<T, N> clamped(Group<T, N> x, Group<T, N> least, Group<T, N> most)
{
    return lesser(most, greater(least, x));
}

template <std::size_t N> HWY_INLINE Group<float, N> to_floats(Group<double, N> x)
{
    if constexpr (Group<double, N>::kWhole)
        return Group<float, N>(hn::DemoteTo(hn::CappedTag<float, N>(), x.v));
    else
        return {to_floats(x.v.low), to_floats(x.v.high)};
}
template <std::size_t N> HWY_INLINE Group<double, N> to_doubles(Group<float, N> x)
{
    if constexpr (Group<double, N>::kWhole)
        return Group<double, N>(hn::PromoteTo(hn::CappedTag<double, N>(), x.v));
    else
        return {to_doubles(x.low()), to_doubles(x.high())};
}

/// The sum of all lanes, by halves: of eight ((0 + 4) + (2 + 6)) + ((1 + 5) + (3 + 7)), on any
/// target.
template <class T, std::size_t N> HWY_INLINE T sum_of(Group<T, N> x)
{
    if constexpr (N == 1)
        return hn::GetLane(x.v);
    else
        return sum_of(x.low() + x.high());
}

HWY_INLINE Doubles four(double a, double b, double c, double d)
{
    using Two = Group<double, 2>;
#if HWY_TARGET == HWY_SCALAR
    return {Two(a, b), Two(c, d)};
#else
    using Tag = Two::Tag;
    return {Two(hn::InterleaveLower(Tag(), hn::Set(Tag(), a), hn::Set(Tag(), b))),
            Two(hn::InterleaveLower(Tag(), hn::Set(Tag(), c), hn::Set(Tag(), d)))};
#endif
}

/// Toward zero.
template <std::size_t N> HWY_INLINE Group<std::int32_t, N> to_integers(Group<double, N> x)
{
    if constexpr (Group<double, N>::kWhole)
        return Group<std::int32_t, N>(hn::DemoteTo(hn::CappedTag<std::int32_t, N>(), x.v));
    else
        return {to_integers(x.v.low), to_integers(x.v.high)};
}
/// To choose integers by.
template <std::size_t N> HWY_INLINE Truths<std::int32_t, N> for_integers(Truths<float, N> truths)
{
    if constexpr (Truths<float, N>::kWhole)
        return {hn::RebindMask(hn::CappedTag<std::int32_t, N>(), truths.m)};
    else
        return {{for_integers(truths.m.low), for_integers(truths.m.high)}};
}

/// The lanes I of a group.
template <std::size_t... I, class T, std::size_t N> HWY_INLINE Group<T, N> pick(Group<T, N> from)
{
    static_assert(sizeof...(I) == N);
    if constexpr (Group<T, N>::kWhole && N > 1) {
        using Tag = hn::CappedTag<T, N>;
        alignas(kLanesAlignment) static constexpr hwy::MakeSigned<T> kIndex[N] = {I...};
        return Group<T, N>(hn::TableLookupLanes(from.v, hn::SetTableIndices(Tag(), kIndex)));
    } else {
        alignas(kLanesAlignment) T all[N];
        store(from, all);
        alignas(kLanesAlignment) const T picked[N] = {all[I]...};
        return Group<T, N>::load(picked);
    }
}

} // namespace vdb_shell::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
