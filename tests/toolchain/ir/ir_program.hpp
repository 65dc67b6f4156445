// ir_program.hpp - LLVM IR as text, brought to the back end's representation and executed there.
// Depends on   toolchain/ir, tests/toolchain/codegen/interpreter.hpp.
#pragma once

#include <llvm/ADT/APInt.h>
#include <llvm/AsmParser/Parser.h>
#include <llvm/IR/LLVMContext.h>
#include <llvm/IR/Module.h>
#include <llvm/IR/Verifier.h>
#include <llvm/Support/SourceMgr.h>
#include <llvm/Support/raw_ostream.h>

#include <memory>
#include <stdexcept>
#include <string>

#include "tests/toolchain/codegen/interpreter.hpp"
#include "toolchain/codegen/lower_calls.hpp"
#include "toolchain/codegen/mir.hpp"
#include "toolchain/ir/prepare.hpp"
#include "toolchain/ir/select.hpp"

namespace ir_test {

/// Data layout of the front end's target with packed structs in mind: 16-bit pointers.
inline constexpr const char* kHead =
    "target datalayout = \"e-m:e-p:16:16-i32:16-i64:16-f32:16-f64:16-a:8-n8:16-S16\"\n"
    "target triple = \"msp430-unknown-none-elf\"\n";

/// Verified functions of a prepared module.
inline toolchain::codegen::Module to_mir(llvm::Module& module) {
    toolchain::ir::prepare(module);
    toolchain::codegen::Module mir = toolchain::ir::select(module);
    for (const toolchain::codegen::Function& function : mir.functions) {
        const std::string problem = verify(function);
        if (!problem.empty()) {
            throw std::runtime_error(mir.symbols[function.symbol] + ": " + problem);
        }
    }
    return mir;
}

inline std::unique_ptr<llvm::Module> parse(const std::string& text, llvm::LLVMContext& context) {
    llvm::SMDiagnostic problem;
    std::unique_ptr<llvm::Module> module =
        llvm::parseAssemblyString(kHead + text, problem, context);
    if (!module) throw std::runtime_error(problem.getMessage().str());
    return module;
}

/// The same behind lower_calls(): calls through registers, narrow runtime routines.
inline toolchain::codegen::Module lowered(toolchain::codegen::Module mir) {
    toolchain::codegen::lower_calls(mir);
    for (const toolchain::codegen::Function& function : mir.functions) {
        const std::string problem = verify(function);
        if (!problem.empty()) {
            throw std::runtime_error(mir.symbols[function.symbol] + ", lowered: " + problem);
        }
    }
    return mir;
}

inline toolchain::codegen::Module to_mir(const std::string& text) {
    llvm::LLVMContext context;
    return to_mir(*parse(text, context));
}

/// IR behind one pass: verified, as text, and as the whole pipeline has it in the end.
class Passed {
public:
    Passed(const std::string& source, void (*pass)(llvm::Function&)) {
        module_ = parse(source, context_);
        for (llvm::Function& function : *module_) {
            if (!function.isDeclaration()) pass(function);
        }
        llvm::raw_string_ostream stream(text);
        if (llvm::verifyModule(*module_, &stream)) throw std::runtime_error(text);
        module_->print(stream, nullptr);
        mir = to_mir(*module_);
    }
    /// How often the words occur.
    [[nodiscard]] unsigned count(const std::string& words) const {
        unsigned found = 0;
        for (auto at = text.find(words); at != std::string::npos; at = text.find(words, at + 1)) {
            ++found;
        }
        return found;
    }

    std::string text;
    toolchain::codegen::Module mir;

private:
    llvm::LLVMContext context_;
    std::unique_ptr<llvm::Module> module_;
};

/// Why a module is not compiled, or "accepted".
inline std::string refusal(const std::string& text) {
    try {
        static_cast<void>(to_mir(text));
    } catch (const toolchain::ir::Refused& refused) {
        return refused.what();
    }
    return "accepted";
}

/// C++20 as i85cc reads it: the front end's IR, loop bounds taken, then optimised at `level`
/// (0, 1, 2, s) by us. @errors std::runtime_error: clang's failure
std::unique_ptr<llvm::Module> compile(const std::string& source, const std::string& level,
                                      llvm::LLVMContext& context);

}  // namespace ir_test
