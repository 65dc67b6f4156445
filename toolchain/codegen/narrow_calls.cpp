// narrow_calls.cpp - see narrow_calls.hpp.
#include "toolchain/codegen/narrow_calls.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <optional>
#include <string>
#include <utility>

#include "toolchain/codegen/builder.hpp"
#include "toolchain/codegen/known_bytes.hpp"

namespace toolchain::codegen {

namespace {

/// A narrowed call may let the next one be narrowed: its high bytes are zeros then.
constexpr int kRounds = 4;

/// How an argument continues above its bytes.
enum class Extension : uint8_t { zero, sign };

struct Operand {
    Bytes bytes{};
    Extension extension = Extension::zero;
    std::size_t zero_width = 0;  ///< it is the zero extension of that many bytes
    std::size_t sign_width = 0;  ///< it is the sign extension of that many bytes
};

class Narrower {
public:
    Narrower(Module& module, Function& function)
        : module_(module),
          function_(function),
          before_(function),
          known_(before_),
          demanded_(demanded_bytes(module, before_)),
          builder_(function) {}

    /// @return false if nothing has changed
    bool run() {
        for (ByteId byte = 0; byte < function_.bytes.size(); ++byte) replaced_.push_back(byte);
        for (BlockId id = 0; id < before_.blocks.size(); ++id) {
            builder_.set_block(id);
            function_.blocks[id].operations.clear();
            for (const Operation& operation : before_.blocks[id].operations) visit(operation);
        }
        if (changed_) replace_uses();
        return changed_;
    }

private:
    void keep(const Operation& operation) {
        function_.blocks[builder_.block()].operations.push_back(operation);
    }

    void visit(const Operation& operation) {
        const bool is_call = operation.opcode == Opcode::call;
        if (!is_call || !is_arithmetic_routine(module_.symbols[operation.symbol])) {
            return keep(operation);
        }
        current_ = &operation;
        builder_.set_place(operation.place);
        std::size_t wanted = operation.results.size();
        while (wanted > 0 && !demanded_[operation.results[wanted - 1]]) --wanted;
        if (wanted == 0) {
            changed_ = true;
            return set_results(builder_.undefined(operation.results.size()));
        }
        const std::string& name = module_.symbols[operation.symbol];
        Bytes results;
        if (name.find("mul") != std::string::npos) {
            results = multiply(name, wanted);
        } else if (name.find("div") != std::string::npos) {
            results = divide(name);
        } else {
            results = shift(name, wanted);
        }
        set_results(results);
    }

    /// Results beyond those given are used only by what nobody needs.
    void set_results(Bytes results) {
        const auto& defined = function_.blocks[builder_.block()].operations;
        const bool kept = !defined.empty() && defined.back().results == current_->results;
        if (kept) return;
        const std::size_t missing = current_->results.size() - results.size();
        const Bytes rest = builder_.undefined(missing);
        results.insert(results.end(), rest.begin(), rest.end());
        for (std::size_t i = 0; i < results.size(); ++i) {
            replaced_[current_->results[i]] = results[i];
        }
    }

    void replace_uses() {
        const auto replace = [this](Bytes& bytes) {
            for (ByteId& byte : bytes) {
                while (byte < replaced_.size() && replaced_[byte] != byte) byte = replaced_[byte];
            }
        };
        for (Block& block : function_.blocks) {
            for (Operation& operation : block.operations) {
                replace(operation.left);
                replace(operation.right);
                for (Bytes& argument : operation.arguments) replace(argument);
            }
            replace(block.terminator.left);
            replace(block.terminator.right);
            for (Edge& edge : block.terminator.edges) replace(edge.arguments);
        }
    }

    // -- Operands --------------------------------------------------------------------------------

    Operand operand(std::size_t number, Extension extension, std::size_t wanted) {
        Operand result;
        result.bytes = current_->arguments[number];
        result.extension = extension;
        result.bytes.resize(std::min(result.bytes.size(), wanted));
        const bool cut = wanted <= result.bytes.size();
        const bool not_negative = known_.is_not_negative(result.bytes.back());
        result.zero_width = known_.zero_width(result.bytes);
        result.sign_width = known_.sign_width(result.bytes);
        if (!cut && extension == Extension::zero && !not_negative) {
            result.sign_width = result.bytes.size() + 1;
        }
        if (!cut && extension == Extension::sign && !not_negative) result.zero_width = wanted;
        return result;
    }

    Bytes take(const Operand& operand, std::size_t size) {
        return operand.extension == Extension::sign ? builder_.sign_extended(operand.bytes, size)
                                                    : builder_.zero_extended(operand.bytes, size);
    }

    /// Calls a routine; the call at hand if it is the same.
    Bytes call(const std::string& name, const std::vector<Bytes>& arguments, std::size_t size) {
        const auto sizes_agree = [&] {
            return std::ranges::equal(
                arguments, current_->arguments,
                [](const Bytes& one, const Bytes& other) { return one.size() == other.size(); });
        };
        if (name == module_.symbols[current_->symbol] && sizes_agree()) {
            keep(*current_);
            return current_->results;
        }
        changed_ = true;
        return builder_.call(module_.intern(name), arguments, size);
    }

    // -- Multiplication --------------------------------------------------------------------------

    Bytes multiply(const std::string& name, std::size_t wanted) {
        const bool is_signed = name == "__smul16w" || name == "__mul8s";
        const Extension extension = is_signed ? Extension::sign : Extension::zero;
        const bool mixed = name == "__mul8_s16w";  // the byte has no sign, the word has
        Operand left = operand(0, extension, wanted);
        Operand right = operand(1, mixed ? Extension::sign : extension, wanted);
        if (left.zero_width > right.zero_width) std::swap(left, right);
        if (left.zero_width == 0) {
            changed_ = true;
            return builder_.constant(0, wanted);
        }
        Bytes product = wanted <= 2   ? multiply_word(left, right, wanted)
                        : wanted <= 4 ? multiply_long(left, right, wanted)
                                      : multiply_wide(left, right, wanted);
        product.resize(std::min(product.size(), wanted));
        return product;
    }

    Bytes multiply_word(const Operand& left, const Operand& right, std::size_t wanted) {
        if (wanted == 1 || right.zero_width <= 1) {
            return call("__mul8", {take(left, 1), take(right, 1)}, 2);
        }
        if (left.sign_width <= 1 && right.sign_width <= 1) {
            return call("__mul8s", {take(left, 1), take(right, 1)}, 2);
        }
        if (left.zero_width <= 1) return call("__mul8_16", {take(left, 1), take(right, 2)}, 2);
        return call("__mul16", {take(left, 2), take(right, 2)}, 2);
    }

    Bytes multiply_long(const Operand& left, const Operand& right, std::size_t wanted) {
        const auto words = [&] { return std::vector<Bytes>{take(left, 2), take(right, 2)}; };
        if (right.zero_width <= 1) {
            const Bytes product = call("__mul8", {take(left, 1), take(right, 1)}, 2);
            return builder_.zero_extended(product, wanted);
        }
        if (left.zero_width <= 1 && right.zero_width <= 2) {
            const Bytes product = call("__mul8_16w", {take(left, 1), take(right, 2)}, 3);
            return builder_.zero_extended(product, wanted);
        }
        if (left.sign_width <= 1 && right.sign_width <= 1) {
            const Bytes product = call("__mul8s", {take(left, 1), take(right, 1)}, 2);
            return builder_.sign_extended(product, wanted);
        }
        if (left.zero_width <= 1 && right.sign_width <= 2) {
            const Bytes product = call("__mul8_s16w", {take(left, 1), take(right, 2)}, 3);
            return builder_.sign_extended(product, wanted);
        }
        if (right.zero_width <= 2) return call("__umul16w", words(), 4);
        if (left.sign_width <= 2 && right.sign_width <= 2) return call("__smul16w", words(), 4);
        if (left.zero_width <= 2) return multiply_parts(left, right, wanted);
        return call("__mul32", {take(left, 4), take(right, 4)}, 4);
    }

    // The left operand is a zero-extended byte or word, the right one is longer: two products, or
    // one and a correction if what is longer is only the sign.
    Bytes multiply_parts(const Operand& left, const Operand& right, std::size_t wanted) {
        const bool byte = left.zero_width <= 1;
        const Bytes low = byte ? call("__mul8_16w", {take(left, 1), take(right, 2)}, 3)
                               : call("__umul16w", {take(left, 2), take(right, 2)}, 4);
        Bytes high(low.begin() + 2, low.end());
        high = builder_.zero_extended(high, wanted - 2);
        const Bytes factor = take(left, wanted - 2);
        if (right.sign_width <= 2) {
            const Bytes negative = builder_.sign_extended({take(right, 2)[1]}, 2);
            const Bytes mask(wanted - 2, negative[1]);
            high = builder_.subtract(high, builder_.bitwise(Opcode::bit_and, factor, mask));
        } else {
            const Bytes whole = take(right, wanted);
            const Bytes rest(whole.begin() + 2, whole.end());
            Bytes part = rest.size() == 1 ? call("__mul8", {{factor[0]}, rest}, 2)
                         : byte           ? call("__mul8_16", {{factor[0]}, rest}, 2)
                                          : call("__mul16", {factor, rest}, 2);
            part.resize(rest.size());
            high = builder_.add(high, part);
        }
        Bytes result(low.begin(), low.begin() + 2);
        result.insert(result.end(), high.begin(), high.end());
        return result;
    }

    Bytes multiply_wide(const Operand& left, const Operand& right, std::size_t wanted) {
        if (left.zero_width + right.zero_width <= 4) {
            return builder_.zero_extended(multiply_long(left, right, 4), wanted);
        }
        if (left.sign_width <= 2 && right.sign_width <= 2) {
            return builder_.sign_extended(multiply_long(left, right, 4), wanted);
        }
        return call("__mul64", {take(left, 8), take(right, 8)}, 8);
    }

    // -- Division --------------------------------------------------------------------------------

    Bytes divide(const std::string& name) {
        const std::size_t size = current_->arguments[0].size();
        const std::size_t divisor_size = current_->arguments[1].size();
        const bool is_signed = name.starts_with("__sdiv");
        if (is_signed && known_.is_not_negative(current_->arguments[0].back()) &&
            known_.is_not_negative(current_->arguments[1].back())) {
            return divide_unsigned(size, divisor_size);
        }
        return is_signed ? divide_signed(size) : divide_unsigned(size, divisor_size);
    }

    /// Quotient and remainder of a routine, extended to the sizes of the call at hand.
    Bytes divide_by(const std::string& name, Extension extension, std::size_t dividend,
                    std::size_t divisor, std::size_t quotient_size) {
        const std::size_t size = current_->results.size() - current_->arguments[1].size();
        const Operand left = operand(0, extension, current_->arguments[0].size());
        const Operand right = operand(1, extension, current_->arguments[1].size());
        const Bytes both =
            call(name, {take(left, dividend), take(right, divisor)}, quotient_size + divisor);
        const auto middle = both.begin() + static_cast<std::ptrdiff_t>(quotient_size);
        const auto extended = [&](const Bytes& bytes, std::size_t to) {
            return extension == Extension::sign ? builder_.sign_extended(bytes, to)
                                                : builder_.zero_extended(bytes, to);
        };
        Bytes results = extended({both.begin(), middle}, size);
        const Bytes remainder = extended({middle, both.end()}, current_->results.size() - size);
        results.insert(results.end(), remainder.begin(), remainder.end());
        return results;
    }

    Bytes divide_unsigned(std::size_t size, std::size_t divisor_size) {
        const std::size_t left = operand(0, Extension::zero, size).zero_width;
        const std::size_t right = operand(1, Extension::zero, divisor_size).zero_width;
        constexpr Extension kZero = Extension::zero;
        if (module_.symbols[current_->symbol] == "__udiv24_8") {
            return divide_by("__udiv24_8", kZero, 3, 1, 2);
        }
        if (left <= 1 && right <= 1) return divide_by("__udiv8", kZero, 1, 1, 1);
        if (left <= 2 && right <= 2) return divide_by("__udiv16", kZero, 2, 2, 2);
        if (left <= 4 && right <= 2) return divide_by("__udiv32_16", kZero, 4, 2, 4);
        if (left <= 4 && right <= 4) return divide_by("__udiv32", kZero, 4, 4, 4);
        return divide_by("__udiv64", kZero, 8, 8, 8);
    }

    // The least number by -1 gives a quotient that is one bit too long: so a narrower routine needs
    // another divisor, or a quotient of which no more is wanted.
    Bytes divide_signed(std::size_t size) {
        const Operand dividend = operand(0, Extension::sign, size);
        const Operand divisor = operand(1, Extension::sign, size);
        const bool fits = known_.is_not_negative(dividend.bytes.back()) ||
                          known_.is_not_negative(divisor.bytes.back()) ||
                          differs_from_minus_1(divisor);
        const std::size_t width = std::max(dividend.sign_width, divisor.sign_width);
        const auto allowed = [&](std::size_t narrow) {
            if (width > narrow) return false;
            bool wanted = false;
            for (std::size_t i = narrow; i < size; ++i) {
                wanted = wanted || demanded_[current_->results[i]];
            }
            return narrow >= size || fits || !wanted;
        };
        constexpr Extension kSign = Extension::sign;
        if (allowed(1)) return divide_by("__sdiv8", kSign, 1, 1, 1);
        if (allowed(2)) return divide_by("__sdiv16", kSign, 2, 2, 2);
        if (allowed(4)) return divide_by("__sdiv32", kSign, 4, 4, 4);
        return divide_by("__sdiv64", kSign, 8, 8, 8);
    }

    [[nodiscard]] bool differs_from_minus_1(const Operand& divisor) const {
        return std::ranges::any_of(divisor.bytes, [&](ByteId byte) {
            const ByteInfo& info = before_.bytes[byte];
            return info.kind == ByteInfo::Kind::constant && info.constant != 0xFF;
        });
    }

    // -- Shifts ----------------------------------------------------------------------------------

    Bytes shift(const std::string& name, std::size_t wanted) {
        const std::size_t size = current_->arguments[0].size();
        const bool left = name.starts_with("__shl");
        const bool is_signed =
            name.starts_with("__ashr") && !known_.is_not_negative(current_->arguments[0].back());
        const Operand value =
            operand(0, is_signed ? Extension::sign : Extension::zero, left ? wanted : size);
        const std::size_t needed =
            left ? wanted
                 : std::max<std::size_t>(1, is_signed ? value.sign_width : value.zero_width);
        const std::size_t width = std::bit_ceil(needed);
        const char* kind = left ? "shl" : is_signed ? "ashr" : "lshr";
        const Bytes shifted = call(fmt::format("__{}{}", kind, width * 8),
                                   {take(value, width), current_->arguments[1]}, width);
        return is_signed ? builder_.sign_extended(shifted, size)
                         : builder_.zero_extended(shifted, size);
    }

    Module& module_;
    Function& function_;
    const Function before_;
    KnownBytes known_;
    std::vector<bool> demanded_;
    Builder builder_;
    std::vector<ByteId> replaced_;
    const Operation* current_ = nullptr;
    bool changed_ = false;
};

}  // namespace

void narrow_calls(Module& module, Function& function) {
    for (int round = 0; round < kRounds; ++round) {
        if (!Narrower(module, function).run()) return;
    }
}

}  // namespace toolchain::codegen
