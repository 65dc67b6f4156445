// operation_values.cpp - operand corners, and what operations give, by the rules of the language.
#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "tests/target/operation_table.hpp"

namespace target_test {

namespace {

std::optional<uint64_t> divide(const std::string& operation, IntType type, uint64_t a, uint64_t b) {
    const Wide left = type.number(a);
    const Wide right = type.number(b);
    if (right == 0) return std::nullopt;
    const Wide quotient = left / right;
    // The least number by -1: C computes int8_t in int, where the quotient exists.
    const bool overflows = type.is_signed && quotient == Wide{1} << (type.bits - 1);
    if (overflows && type.bits != 8) return std::nullopt;
    return static_cast<uint64_t>(operation == "div" ? quotient : left % right) & type.mask();
}

/// What an addition, subtraction or multiplication gives.
struct Exact {
    Wide value;         ///< a product of 128 bits does not fit: the greatest Wide then
    uint64_t low_bits;  ///< of the exact result, always right
};

Exact exact(const std::string& operation, Wide left, Wide right) {
    const auto a = static_cast<uint64_t>(left);
    const auto b = static_cast<uint64_t>(right);
    if (operation.starts_with("add")) return {left + right, a + b};
    if (operation.starts_with("sub")) return {left - right, a - b};
    Wide product = 0;
    if (__builtin_mul_overflow(left, right, &product)) {
        // Only two unsigned factors of 64 bits are that large.
        product = static_cast<Wide>(~UnsignedWide{0} >> 1);
    }
    return {product, a * b};
}

Wide least(IntType type) {
    return type.is_signed ? -(Wide{1} << (type.bits - 1)) : Wide{0};
}

Wide greatest(IntType type) {
    return (Wide{1} << (type.is_signed ? type.bits - 1 : type.bits)) - 1;
}

uint64_t rotate_left(IntType type, uint64_t a, uint64_t count) {
    count %= type.bits;
    if (count == 0) return a;
    return (a << count | a >> (type.bits - count)) & type.mask();
}

/// One bit for each of == != < <= > >=.
uint64_t comparisons(Wide left, Wide right) {
    return static_cast<uint64_t>((left == right ? 1 : 0) | (left != right ? 2 : 0) |
                                 (left < right ? 4 : 0) | (left <= right ? 8 : 0) |
                                 (left > right ? 16 : 0) | (left >= right ? 32 : 0));
}

}  // namespace

std::string IntType::c_name() const {
    return fmt::format("{}{}", is_signed ? "s" : "u", bits);
}

std::string IntType::ir_name() const {
    return fmt::format("i{}", bits);
}

Wide IntType::number(uint64_t value) const {
    value &= mask();
    if (is_signed && (value >> (bits - 1) & 1) != 0) return Wide{value} - (Wide{1} << bits);
    return Wide{value};
}

std::vector<uint64_t> corners(IntType type) {
    const uint64_t half = uint64_t{1} << (type.bits - 1);
    std::vector<uint64_t> values = {0,
                                    1,
                                    2,
                                    3,
                                    7,
                                    10,
                                    type.mask(),
                                    half,
                                    half - 1,
                                    half + 1,
                                    ~1ULL,
                                    0x55,
                                    0xAAAAAAAAAAAAAAAAULL,
                                    0x80,
                                    0xFF,
                                    0x100,
                                    0x101,
                                    0x7F80,
                                    0x8000,
                                    0xFFFF,
                                    0x10000,
                                    0xFF00FF00FF00FF00ULL,
                                    0xFFFF0000,
                                    0x80000000,
                                    0x0123456789ABCDEFULL,
                                    0xFFFFFFFFFF00ULL,
                                    1000,
                                    ~999ULL};
    for (uint64_t& value : values) value &= type.mask();
    std::ranges::sort(values);
    values.erase(std::ranges::unique(values).begin(), values.end());
    return values;
}

std::optional<uint64_t> evaluate(const std::string& operation, IntType type, uint64_t a,
                                 uint64_t b) {
    const Wide left = type.number(a);
    const Wide right = type.number(b);
    const auto wrapped = [&](Wide value) { return static_cast<uint64_t>(value) & type.mask(); };
    if (operation == "div" || operation == "rem") return divide(operation, type, a, b);
    if (operation == "and") return a & b;
    if (operation == "or") return a | b;
    if (operation == "xor") return a ^ b;
    if (operation == "min") return wrapped(std::min(left, right));
    if (operation == "max") return wrapped(std::max(left, right));
    if (operation == "cmp") return comparisons(left, right);
    if (operation == "shl" || operation == "shr") {
        if (b >= type.bits) return std::nullopt;
        return wrapped(operation == "shl" ? Wide{a} << b : left >> b);
    }
    if (operation == "rotl") return rotate_left(type, a, b % type.bits);
    if (operation == "rotr") return rotate_left(type, a, type.bits - b % type.bits);
    const auto [result, low_bits] = exact(operation, left, right);
    if (operation.ends_with("sat")) {
        return wrapped(std::clamp(result, least(type), greatest(type)));
    }
    if (operation.ends_with("ov")) {  // the lowest bit tells of overflow
        const bool overflows = result < least(type) || result > greatest(type);
        return (low_bits & type.mask()) ^ (overflows ? 1 : 0);
    }
    return low_bits & type.mask();
}

}  // namespace target_test
