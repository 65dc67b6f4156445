// known_bytes.hpp - what is known about bytes without running the function: which ones matter,
// which are zero, which are copies of a sign. Depends on   mir.hpp, before lower_calls().
#pragma once

#include <cstddef>
#include <set>
#include <utility>
#include <vector>

#include "toolchain/codegen/mir.hpp"

namespace toolchain::codegen {

/// Calls without an effect but their result: `__mul16`, `__udiv32`, `__shl8` ...
[[nodiscard]] bool is_arithmetic_routine(const std::string& name);

/// For every byte: does anything that the function does depend on it?
[[nodiscard]] std::vector<bool> demanded_bytes(const Module& module, const Function& function);

/// Answers about single bytes and values of a function, which must not change meanwhile.
class KnownBytes {
public:
    explicit KnownBytes(const Function& function);

    [[nodiscard]] bool is_constant(ByteId byte, uint8_t value);
    /// Its top bit is 0.
    [[nodiscard]] bool is_not_negative(ByteId byte);
    /// `byte` is FFH if the top bit of `of` is 1, else 0.
    [[nodiscard]] bool is_sign_of(ByteId byte, ByteId of);

    /// The value is the zero extension of that many of its bytes.
    [[nodiscard]] std::size_t zero_width(const Bytes& value);
    /// The value is the sign extension of that many of its bytes, at least one.
    [[nodiscard]] std::size_t sign_width(const Bytes& value);

private:
    struct Origin {
        const Operation* operation = nullptr;
        BlockId block = kNone;  ///< of a parameter
        std::size_t index = 0;  ///< among the operation's results or the block's parameters
    };
    /// A question about a parameter is answered for all edges; on the way round a loop the answer
    /// is taken to be yes, for as long as no edge says no.
    using Question = std::pair<ByteId, ByteId>;

    template <typename Ask>
    bool for_all_edges(Question question, const Origin& origin, Ask ask);

    const Function& function_;
    std::vector<Origin> origins_;
    std::vector<std::vector<const Edge*>> edges_;  ///< to each block
    std::set<Question> assumed_;
};

}  // namespace toolchain::codegen
