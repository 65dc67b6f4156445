// must_not_compile.cpp - one misuse of firmware/core per case; check_refused.cmake compiles each.
// Case 0 is the control: it must compile. The others must be refused with an error that matches the
// `expect` comment on their first line, so that a typing mistake here cannot pass for a refusal.
#include "firmware/core/atan2.hpp"
#include "firmware/core/isqrt.hpp"
#include "firmware/core/ring.hpp"
#include "firmware/core/sine.hpp"

using namespace rover;

constexpr uint16_t kTable[4] = {1, 2, 3, 4};

#if ROVER_CASE == 0  // control
auto result = add_wrap(Brad16{1}, Brad16{2});
auto sum = add_wrap(uint16_t{1}, uint16_t{2});
auto root = isqrt(uint16_t{9});
auto entry = look_up(kTable, uint8_t{1});
Ring<uint8_t, 32> ring;
#elif ROVER_CASE == 1   // adding_an_angle_to_a_length expect: no matching function.*add_wrap
auto result = add_wrap(Brad16{1}, Q4Mm{2});
#elif ROVER_CASE == 2   // adding_an_int_to_a_u16 expect: no matching function.*add_wrap
auto result = add_wrap(uint16_t{1}, 2);
#elif ROVER_CASE == 3   // square_root_of_an_int expect: no matching function.*isqrt
auto result = isqrt(9);
#elif ROVER_CASE == 4   // multiplying_ints expect: no matching function.*mul_wide
auto result = mul_wide(3, 4);
#elif ROVER_CASE == 5   // an_angle_as_an_integer expect: cannot convert|cannot init|no viable
int16_t result = Brad16{5};
#elif ROVER_CASE == 6   // operator_plus_on_units expect: no match for .*operator|invalid operands
auto result = Q4Mm{5} + Q4Mm{6};
#elif ROVER_CASE == 7   // saturating_angles expect: no matching function.*add_sat
auto result = add_sat(Brad16{5}, Brad16{6});
#elif ROVER_CASE == 8   // wrapping_ratios expect: no matching function.*add_wrap
auto result = add_wrap(Q15{5}, Q15{6});
#elif ROVER_CASE == 9   // int_fraction_of_lerp expect: no matching function.*lerp_q6
auto result = lerp_q6(int16_t{1}, int16_t{2}, 32);
#elif ROVER_CASE == 10  // ring_of_24_items expect: a ring has a power of two of items
Ring<uint8_t, 24> result;
#elif ROVER_CASE == 11  // widening_signed_to_unsigned expect: no matching function.*widen_u16
auto result = widen_u16(int8_t{-1});
#elif ROVER_CASE == 12  // floating_point expect: no matching function.*add_wrap
auto result = add_wrap(1.0f, 2.0f);
#elif ROVER_CASE == 13  // a_wide_integer_as_an_angle expect: no matching function.*to_unit
auto result = to_unit<Brad16>(int32_t{1});
#elif ROVER_CASE == 14  // a_signed_table_index expect: no matching function.*look_up
auto result = look_up(kTable, int8_t{1});
#elif ROVER_CASE == 15  // bits_of_a_signed_word expect: no matching function.*bit_and
auto result = bit_and(int16_t{1}, int16_t{2});
#elif ROVER_CASE == 16  // sine_of_a_length expect: no matching function.*sine
auto result = sine(Q4Mm{5});
#elif ROVER_CASE == 17  // mixed_signs expect: no matching function.*min
auto result = rover::min(uint16_t{1}, int16_t{2});
#elif ROVER_CASE == 18  // division_of_mixed_widths expect: no matching function.*div_floor
auto result = div_floor(int32_t{1}, int16_t{2});
#endif
