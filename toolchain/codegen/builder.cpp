// builder.cpp - see builder.hpp.
#include "toolchain/codegen/builder.hpp"

#include <algorithm>
#include <utility>

namespace toolchain::codegen {

namespace {

using Kind = ByteInfo::Kind;

constexpr unsigned kByteBits = 8;

uint64_t mask_of(std::size_t size) {
    return size >= 8 ? UINT64_MAX : (uint64_t{1} << size * kByteBits) - 1;
}

}  // namespace

// Equal constants and addresses are one byte, so that code generation sees that they are equal.
ByteId Builder::interned(const ByteInfo& info) {
    const auto key = std::make_tuple(info.kind, info.constant, info.symbol, info.offset);
    const auto [entry, added] = interned_.try_emplace(key, kNone);
    if (added) entry->second = new_byte(info);
    return entry->second;
}

ByteId Builder::new_byte(const ByteInfo& info) {
    function_.bytes.push_back(info);
    return static_cast<ByteId>(function_.bytes.size() - 1);
}

Bytes Builder::new_results(std::size_t size) {
    Bytes results;
    for (std::size_t i = 0; i < size; ++i) results.push_back(new_byte({Kind::computed}));
    return results;
}

Operation& Builder::append(Opcode opcode) {
    std::vector<Operation>& operations = function_.blocks[block_].operations;
    operations.push_back({});
    operations.back().opcode = opcode;
    operations.back().place = place_;
    return operations.back();
}

// -- Bytes that need no code
// -------------------------------------------------------------------------

ByteId Builder::constant_byte(uint8_t value) {
    return interned({Kind::constant, value});
}

Bytes Builder::constant(uint64_t value, std::size_t size) {
    Bytes bytes;
    for (std::size_t i = 0; i < size; ++i) {
        bytes.push_back(
            constant_byte(i < 8 ? static_cast<uint8_t>(value >> i * kByteBits) : uint8_t{0}));
    }
    return bytes;
}

Bytes Builder::address(SymbolId symbol, int32_t offset) {
    return {interned({Kind::address_low, 0, symbol, offset}),
            interned({Kind::address_high, 0, symbol, offset})};
}

Bytes Builder::undefined(std::size_t size) {
    Bytes bytes;
    for (std::size_t i = 0; i < size; ++i) bytes.push_back(new_byte({Kind::undefined}));
    return bytes;
}

Bytes Builder::parameter(std::size_t size) {
    Bytes bytes;
    for (std::size_t i = 0; i < size; ++i) bytes.push_back(new_byte({Kind::parameter}));
    return bytes;
}

Bytes Builder::zero_extended(Bytes value, std::size_t size) {
    value.resize(std::min(value.size(), size));
    while (value.size() < size) value.push_back(constant_byte(0));
    return value;
}

Bytes Builder::sign_extended(Bytes value, std::size_t size) {
    if (value.size() >= size) {
        value.resize(size);
        return value;
    }
    value.resize(size, sign_of(value.back()));
    return value;
}

/// FFH if the byte is negative, else 0.
ByteId Builder::sign_of(ByteId byte) {
    const ByteInfo top = info(byte);
    if (top.kind == Kind::constant) return constant_byte((top.constant & 0x80) != 0 ? 0xFF : 0);
    const ByteId fill = new_byte({Kind::computed});
    Operation& operation = append(Opcode::sign_fill);
    operation.left = {byte};
    operation.results = {fill};
    return fill;
}

std::optional<uint64_t> Builder::value_of(const Bytes& value) const {
    if (value.size() > 8) return std::nullopt;
    uint64_t number = 0;
    for (std::size_t i = 0; i < value.size(); ++i) {
        const ByteInfo& byte = info(value[i]);
        if (byte.kind != Kind::constant) return std::nullopt;
        number |= uint64_t{byte.constant} << i * kByteBits;
    }
    return number;
}

std::size_t Builder::leading_zero_bytes(const Bytes& value) const {
    std::size_t count = 0;
    while (count < value.size() && is_constant(value[value.size() - 1 - count], 0)) ++count;
    return count;
}

bool Builder::is_constant(ByteId byte, uint8_t value) const {
    return info(byte).kind == Kind::constant && info(byte).constant == value;
}

// -- Computation
// -------------------------------------------------------------------------------------

std::optional<Bytes> Builder::add_to_address(const Bytes& left, const Bytes& right) {
    if (left.size() != 2) return std::nullopt;
    const ByteInfo low = info(left[0]);
    const ByteInfo high = info(left[1]);
    const auto number = value_of(right);
    if (!number || low.kind != Kind::address_low || high.kind != Kind::address_high ||
        low.symbol != high.symbol || low.offset != high.offset) {
        return std::nullopt;
    }
    const auto offset = static_cast<int16_t>(low.offset + static_cast<int32_t>(*number));
    return address(low.symbol, offset);
}

Bytes Builder::add(const Bytes& left, const Bytes& right) {
    const auto left_value = value_of(left);
    const auto right_value = value_of(right);
    if (left_value && right_value) {
        return constant((*left_value + *right_value) & mask_of(left.size()), left.size());
    }
    if (left_value) return add(right, left);
    if (auto sum = add_to_address(left, right)) return *sum;
    return carry_chain(Opcode::add, left, right);
}

/// A byte of a sum or difference that neither takes nor leaves a carry, if it needs no code.
std::optional<ByteId> Builder::without_carry(Opcode opcode, ByteId left, ByteId right) {
    if (is_constant(right, 0)) return left;
    if (opcode == Opcode::add && is_constant(left, 0)) return right;
    const ByteInfo one = info(left);
    const ByteInfo other = info(right);
    if (one.kind != Kind::constant || other.kind != Kind::constant) return std::nullopt;
    const int value =
        opcode == Opcode::add ? one.constant + other.constant : one.constant - other.constant;
    if (value < 0 || value > 0xFF) return std::nullopt;
    return constant_byte(static_cast<uint8_t>(value));
}

// From the bottom on, bytes without a carry are there already.
Bytes Builder::carry_chain(Opcode opcode, const Bytes& left, const Bytes& right) {
    Bytes result;
    std::size_t kept = 0;
    for (; kept < left.size(); ++kept) {
        const auto byte = without_carry(opcode, left[kept], right[kept]);
        if (!byte) break;
        result.push_back(*byte);
    }
    const auto from = static_cast<std::ptrdiff_t>(kept);
    if (kept == left.size()) return result;
    const Bytes results = new_results(left.size() - kept);
    Operation& operation = append(opcode);
    operation.left.assign(left.begin() + from, left.end());
    operation.right.assign(right.begin() + from, right.end());
    operation.results = results;
    result.insert(result.end(), results.begin(), results.end());
    return result;
}

Bytes Builder::subtract(const Bytes& left, const Bytes& right) {
    if (const auto right_value = value_of(right)) {
        const uint64_t negative = (0 - *right_value) & mask_of(left.size());
        return add(left, constant(negative, left.size()));
    }
    if (left == right) return constant(0, left.size());
    return carry_chain(Opcode::subtract, left, right);
}

ByteId Builder::bitwise_byte(Opcode opcode, ByteId left, ByteId right) {
    if (info(left).kind == Kind::constant) std::swap(left, right);
    const ByteInfo first = info(left);
    const ByteInfo second = info(right);
    if (first.kind == Kind::constant && second.kind == Kind::constant) {
        const uint8_t a = first.constant;
        const uint8_t b = second.constant;
        return constant_byte(opcode == Opcode::bit_and  ? a & b
                             : opcode == Opcode::bit_or ? a | b
                                                        : a ^ b);
    }
    if (left == right) return opcode == Opcode::bit_xor ? constant_byte(0) : left;
    if (is_constant(right, 0)) return opcode == Opcode::bit_and ? right : left;
    if (is_constant(right, 0xFF) && opcode == Opcode::bit_and) return left;
    if (is_constant(right, 0xFF) && opcode == Opcode::bit_or) return right;
    const ByteId result = new_byte({Kind::computed});
    Operation& operation = append(opcode);
    operation.left = {left};
    operation.right = {right};
    operation.results = {result};
    return result;
}

Bytes Builder::bitwise(Opcode opcode, const Bytes& left, const Bytes& right) {
    Bytes result;
    for (std::size_t i = 0; i < left.size(); ++i) {
        result.push_back(bitwise_byte(opcode, left[i], right[i]));
    }
    return result;
}

Bytes Builder::shifted(Opcode opcode, const Bytes& value, unsigned bits) {
    if (bits == 0 || value.empty()) return value;
    if (const auto number = value_of(value); number && opcode != Opcode::shift_right_signed) {
        return constant(opcode == Opcode::shift_left ? *number << bits : *number >> bits,
                        value.size());
    }
    const Bytes results = new_results(value.size());
    Operation& operation = append(opcode);
    operation.left = value;
    operation.immediate = static_cast<uint8_t>(bits);
    operation.results = results;
    return results;
}

Bytes Builder::shift_left(const Bytes& value, unsigned count) {
    const std::size_t moved = std::min<std::size_t>(count / kByteBits, value.size());
    const Bytes rest(value.begin(), value.end() - static_cast<std::ptrdiff_t>(moved));
    const Bytes high = shifted(Opcode::shift_left, rest, count % kByteBits);
    Bytes result = constant(0, moved);
    result.insert(result.end(), high.begin(), high.end());
    return result;
}

Bytes Builder::shift_right(const Bytes& value, unsigned count) {
    const std::size_t moved = std::min<std::size_t>(count / kByteBits, value.size());
    Bytes rest(value.begin() + static_cast<std::ptrdiff_t>(moved), value.end());
    // Bytes at the top that are zero stay so.
    rest.resize(rest.size() - leading_zero_bytes(rest));
    return zero_extended(shifted(Opcode::shift_right, rest, count % kByteBits), value.size());
}

Bytes Builder::shift_right_signed(const Bytes& value, unsigned count) {
    const std::size_t moved = std::min<std::size_t>(count / kByteBits, value.size() - 1);
    const Bytes rest(value.begin() + static_cast<std::ptrdiff_t>(moved), value.end());
    if (const auto number = value_of(rest)) {
        const unsigned unused = static_cast<unsigned>(8 - rest.size()) * kByteBits;
        const auto wide = static_cast<int64_t>(*number << unused) >> unused;
        return constant(static_cast<uint64_t>(wide >> count % kByteBits), value.size());
    }
    if (rest.size() == 1 && count % kByteBits == kByteBits - 1) {  // nothing but the sign
        return Bytes(value.size(), sign_extended(rest, 2)[1]);
    }
    return sign_extended(shifted(Opcode::shift_right_signed, rest, count % kByteBits),
                         value.size());
}

ByteId Builder::compare(Predicate predicate, const Bytes& left, const Bytes& right) {
    const ByteId result = new_byte({Kind::computed});
    Operation& operation = append(Opcode::compare);
    operation.predicate = predicate;
    operation.left = left;
    operation.right = right;
    operation.results = {result};
    return result;
}

// -- Memory and calls
// --------------------------------------------------------------------------------

Bytes Builder::load(const Bytes& address, std::size_t size, bool is_volatile) {
    const Bytes results = new_results(size);
    Operation& operation = append(Opcode::load);
    operation.left = address;
    operation.is_volatile = is_volatile;
    operation.results = results;
    return results;
}

void Builder::store(const Bytes& address, const Bytes& value, bool is_volatile) {
    Operation& operation = append(Opcode::store);
    operation.left = address;
    operation.right = value;
    operation.is_volatile = is_volatile;
}

Bytes Builder::call(SymbolId symbol, std::vector<Bytes> arguments, std::size_t result_size) {
    const Bytes results = new_results(result_size);
    Operation& operation = append(Opcode::call);
    operation.symbol = symbol;
    operation.arguments = std::move(arguments);
    operation.results = results;
    return results;
}

Bytes Builder::call_indirect(const Bytes& target, std::vector<Bytes> arguments,
                             std::size_t result_size) {
    const Bytes results = new_results(result_size);
    Operation& operation = append(Opcode::call_indirect);
    operation.left = target;
    operation.arguments = std::move(arguments);
    operation.results = results;
    return results;
}

Bytes Builder::processor(Opcode opcode, uint8_t immediate, const Bytes& operand,
                         std::size_t result_size) {
    const Bytes results = new_results(result_size);
    Operation& operation = append(opcode);
    operation.immediate = immediate;
    operation.left = operand;
    operation.results = results;
    return results;
}

void Builder::terminate(Terminator terminator) {
    terminator.place = place_;
    function_.blocks[block_].terminator = std::move(terminator);
}

}  // namespace toolchain::codegen
