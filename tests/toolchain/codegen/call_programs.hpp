// call_programs.hpp - modules that consist of calls, made from a table.
#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <vector>

#include "toolchain/codegen/builder.hpp"
#include "toolchain/codegen/mir.hpp"

namespace codegen_test {

/// Function i is called "f<i>" and calls those named, at line 10 i + (1, 2 ...) of t.c.
inline toolchain::codegen::Module module_with_calls(
    const std::vector<std::vector<std::size_t>>& calls) {
    using namespace toolchain::codegen;
    Module module;
    module.files = {"t.c"};
    for (std::size_t i = 0; i < calls.size(); ++i) {
        Function function;
        function.symbol = module.intern(fmt::format("f{}", i));
        function.blocks.emplace_back();
        Builder builder(function);
        uint32_t line = static_cast<uint32_t>(10 * i);
        for (const std::size_t callee : calls[i]) {
            builder.set_place({0, ++line});
            (void)builder.call(module.intern(fmt::format("f{}", callee)), {}, 0);
        }
        Terminator end;
        end.kind = Terminator::Kind::give_back;
        builder.terminate(end);
        module.functions.push_back(function);
    }
    return module;
}

}  // namespace codegen_test
