// map_grid_surface.hpp - map of the load-bearing surface: look-up, start, extension, correction.
// Depends on   map_grid_state.hpp.
// Source       Wilcox 1994, steps 3 and 4, on a fixed world grid.
// Design note  docs/design/slip-and-sinkage.md
// Bounds       every loop runs over at most the 32 nodes of the ring.
// Tests        tests/firmware/estimation/map_grid_surface_test.cpp
#pragma once

#include "firmware/estimation/map_grid_state.hpp"

namespace rover::slip {

/// Node whose place is at or just before `place`.
constexpr U16 node_before(U16 place_q6_bin) {
    return shift_floor<6>(place_q6_bin);
}

/// A node's place in the ring; of the node only the low bits matter.
constexpr uint8_t ring_index(U8 node) {
    return index_of(bit_and(node, U8{kNodeCount - 1u}));
}
constexpr S16& node_height(MapGrid& map, U8 node) {
    return map.surface_q4_mm[ring_index(node)];
}
constexpr S16 node_height(const MapGrid& map, U8 node) {
    return map.surface_q4_mm[ring_index(node)];
}
constexpr S16& node_height(MapGrid& map, U16 node) {
    return node_height(map, narrow_wrap_u8(node));
}

/// A place as node (modulo 256) in the high byte and 1/256 bin in the low byte: both are at hand.
constexpr U16 split_place(U16 place_q6_bin) {
    return shift_left_wrap<2>(place_q6_bin);
}
constexpr U8 node_of(U16 split) {
    return narrow_wrap_u8(shift_floor<8>(split));
}
constexpr U8 fraction_q8_of(U16 split) {
    return narrow_wrap_u8(split);
}

/// a + (b - a) * fraction / 256, rounded half up. The difference must fit in an S16.
[[gnu::noinline]] constexpr S16 lerp_at(S16 a, S16 b, U8 fraction_q8) {
    return lerp_q8(a, b, fraction_q8);
}

/// 256 a / b rounded half up, 255 at most, for a <= b < 2^15.
/// @cost  at most 900 T
[[gnu::noinline]] constexpr U8 ratio_q8(U16 a, U16 b) {
    U8 ratio{0};
    uint8_t left = 8;
    do {
        a = shift_left_wrap<1>(a);
        ratio = shift_left_wrap<1>(ratio);
        if (a >= b) {
            a = sub_wrap(a, b);
            ratio = bit_or(ratio, U8{1});
        }
    } while (--left != 0);
    if (shift_left_wrap<1>(a) >= b && ratio != U8{255}) ratio = add_wrap(ratio, U8{1});
    return ratio;
}

/// Surface at any place, s16 Q4 mm: linear between nodes, rounded half up.
[[gnu::noinline]] constexpr S16 surface_at(const MapGrid& map, U16 place_q6_bin) {
    const U16 split = split_place(place_q6_bin);
    const U8 node = node_of(split);
    return lerp_at(node_height(map, node), node_height(map, add_wrap(node, U8{1})),
                   fraction_q8_of(split));
}

/// Forgets surface and samples.
[[gnu::noinline]] constexpr void drop_map(MapGrid& map) {
    map.has_map = false;
    map.measured = false;
    map.has_behind = false;
    map.sinkage_count = 0;
    map.sinkage_valid = false;
    for (U8& fraction : map.ahead.fraction_q8) fraction = U8{0};
}

/// Moves the front end of the map to a new place and height: nodes in between lie on a straight
/// line, and the first node beyond gets the new height, so that the surface has a value up to
/// there.
/// @param to_q6_bin  at most 1408 ahead of the last
[[gnu::noinline]] constexpr void fill_to(MapGrid& map, U16 to_q6_bin, S16 to_q4_mm) {
    const U16 from_q6_bin = map.front_place_q6_bin;
    const S16 from_q4_mm = map.front_height_q4_mm;
    map.front_place_q6_bin = to_q6_bin;
    map.front_height_q4_mm = to_q4_mm;
    const U16 beyond = add_wrap(node_before(to_q6_bin), U16{1});
    const U8 end = narrow_wrap_u8(beyond);
    U8 node = add_wrap(node_of(split_place(from_q6_bin)), U8{1});
    if (node != end) {
        const U16 length = sub_wrap(to_q6_bin, from_q6_bin);
        const U16 along_q6 = sub_wrap(U16{64}, bit_and(from_q6_bin, U16{63}));
        // The way from node to node; with one node in the way only that of `from` to it.
        const bool one = add_wrap(node, U8{1}) == end;
        const U8 share_q8 = ratio_q8(one ? along_q6 : U16{64}, length);
        S16 height = lerp_at(from_q4_mm, to_q4_mm, share_q8);
        const S16 step_q4_mm = sub_wrap(height, from_q4_mm);
        if (!one) {
            height = lerp_at(from_q4_mm, height, narrow_sat_u8(shift_left_wrap<2>(along_q6)));
        }
        while (node != end) {
            node_height(map, node) = height;
            node = add_wrap(node, U8{1});
            height = add_wrap(height, step_q4_mm);
        }
    }
    node_height(map, end) = to_q4_mm;
    const U16 oldest_q6_bin = shift_left_wrap<6>(sub_wrap(beyond, U16{kNodeCount - 1u}));
    if (ahead_of(map.lowest_q6_bin, oldest_q6_bin) > S16{0}) map.lowest_q6_bin = oldest_q6_bin;
}

/// Starts a map from the three contacts: straight lines between them. Ground counts as measured
/// from the front wheel's place on.
constexpr void begin_map(MapGrid& map, const MapGridInput& input, U16 front) {
    const U16 middle = add_wrap(map.place_q6_bin, input.middle_distance_q6_bin);
    const U16 rear_node = node_before(map.place_q6_bin);
    map.lowest_q6_bin = shift_left_wrap<6>(rear_node);
    node_height(map, rear_node) = S16{0};
    map.front_place_q6_bin = map.place_q6_bin;
    map.front_height_q4_mm = S16{0};
    fill_to(map, middle, input.middle_height_q4_mm);
    fill_to(map, front, input.front_height_q4_mm);
    map.front_height_before_q4_mm = input.front_height_q4_mm;
    map.passed_bin = node_of(split_place(front));
    map.measured_from_q6_bin = front;
    map.measured = false;
    map.has_map = true;
    map.front_is_new = true;
}

/// Starts at place 0 on ground of known shape, such as a ramp: it counts as measured.
/// @param surface_q4_mm  load-bearing surface at 0, 2.5 ... 50 cm ahead of the rear contact
constexpr void start_on_known_ground(MapGrid& map, const S16 (&surface_q4_mm)[kKnownNodes]) {
    drop_map(map);
    for (uint8_t node = 0; node < kKnownNodes; ++node) {
        map.surface_q4_mm[node] = surface_q4_mm[node];
    }
    const S16 front_q4_mm = surface_q4_mm[kKnownNodes - 1];
    map.surface_q4_mm[kKnownNodes] = front_q4_mm;
    map.place_q6_bin = U16{0};
    map.lowest_q6_bin = U16{0};
    map.measured_from_q6_bin = U16{0};
    map.passed_bin = U8{kKnownNodes - 1u};
    map.front_place_q6_bin = U16{(kKnownNodes - 1u) * 64u};
    map.front_height_q4_mm = front_q4_mm;
    map.front_height_before_q4_mm = front_q4_mm;
    map.has_map = true;
    map.measured = true;
}

/// Running mean of |second difference| of successive front-wheel heights: what a straight line
/// between samples misses.
constexpr void learn_roughness(MapGrid& map, S16 front_height_q4_mm) {
    const S16 step = sub_wrap(front_height_q4_mm, map.front_height_q4_mm);
    const S16 step_before = sub_wrap(map.front_height_q4_mm, map.front_height_before_q4_mm);
    const U16 bend_q4_mm = min(abs_u16(sub_wrap(step, step_before)), U16{kBendMaxQ4Mm});
    map.rough_q8_mm = narrow_wrap_u16(lerp_at(narrow_wrap_s16(map.rough_q8_mm),
                                              narrow_wrap_s16(shift_left_wrap<4>(bend_q4_mm)),
                                              U8{kLearnGainQ8[map.rough_count]}));
    if (map.rough_count < kLearnSteps) ++map.rough_count;
}

/// Extends the map to the front wheel and splits the middle wheel's misfit over its two nodes.
/// @return  height of the rear contact, s16 Q4 mm: mean of what rear and middle wheel say
constexpr S16 extend_map(MapGrid& map, const MapGridInput& input, U16 front) {
    const U16 middle = add_wrap(map.place_q6_bin, input.middle_distance_q6_bin);
    const S16 by_rear = surface_at(map, map.place_q6_bin);
    const S16 by_middle = sub_wrap(surface_at(map, middle), input.middle_height_q4_mm);
    const S16 half = halve_floor(sub_wrap(by_middle, by_rear));
    const S16 rear = add_wrap(by_rear, half);
    const S16 quarter = halve_floor(half);
    const U8 node = node_of(split_place(middle));
    node_height(map, node) = sub_wrap(node_height(map, node), quarter);
    const U8 next = add_wrap(node, U8{1});
    node_height(map, next) = sub_wrap(node_height(map, next), quarter);
    if (ahead_of(map.front_place_q6_bin, front) >= S16{0}) {
        const S16 front_height = add_wrap(rear, input.front_height_q4_mm);
        learn_roughness(map, front_height);
        map.front_height_before_q4_mm = map.front_height_q4_mm;
        fill_to(map, front, front_height);
        map.front_is_new = true;
    }
    return rear;
}

}  // namespace rover::slip
