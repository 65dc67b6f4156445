// join.cpp - see join.hpp.
#include "toolchain/driver/join.hpp"

#include <fmt/format.h>
#include <llvm/Demangle/Demangle.h>
#include <llvm/IR/DiagnosticInfo.h>
#include <llvm/IR/DiagnosticPrinter.h>
#include <llvm/IR/IRBuilder.h>
#include <llvm/IRReader/IRReader.h>
#include <llvm/Linker/Linker.h>
#include <llvm/Passes/PassBuilder.h>
#include <llvm/Support/SourceMgr.h>
#include <llvm/Transforms/IPO/GlobalDCE.h>
#include <llvm/Transforms/IPO/Internalize.h>
#include <llvm/Transforms/Utils/ModuleUtils.h>

#include <utility>

namespace toolchain::driver {
namespace {

/// Keeps LLVM's messages instead of printing them.
class Collector : public llvm::DiagnosticHandler {
public:
    explicit Collector(std::string& text) : text_(text) {}

    bool handleDiagnostics(const llvm::DiagnosticInfo& message) override {
        if (message.getSeverity() != llvm::DS_Error) return true;
        llvm::raw_string_ostream stream(text_);
        llvm::DiagnosticPrinterRawOStream printer(stream);
        message.print(printer);
        return true;
    }

private:
    std::string& text_;
};

bool is_interrupt(const llvm::GlobalValue& value) {
    const auto* function = llvm::dyn_cast<llvm::Function>(&value);
    return function != nullptr && function->hasFnAttribute("interrupt");
}

/// "rover::step(int)" and "rover::step" for _ZN5rover4stepEi.
std::pair<std::string, std::string> readable_names(const std::string& symbol) {
    const std::string whole = llvm::demangle(symbol);
    llvm::ItaniumPartialDemangler parts;
    if (parts.partialDemangle(symbol.c_str()) || !parts.isFunction()) return {whole, whole};
    char* text = parts.getFunctionName(nullptr, nullptr);
    std::string name = text != nullptr ? text : whole;
    std::free(text);  // the demangler's interface: malloc
    return {whole, std::move(name)};
}

}  // namespace

ModulePointer read_module(const std::filesystem::path& file, const std::string& name,
                          llvm::LLVMContext& context) {
    llvm::SMDiagnostic problem;
    ModulePointer module = llvm::parseIRFile(file.string(), problem, context);
    if (!module) {
        throw Failed(
            fmt::format("{}:{}: not readable for LLVM 19: {}: use clang-19, and no "
                        "built-in function of another processor",
                        name, std::max(problem.getLineNo(), 1), problem.getMessage().str()));
    }
    constexpr unsigned kPointerBits = 16;
    if (module->getDataLayout().getPointerSizeInBits() != kPointerBits) {
        throw Failed(
            fmt::format("{}: made for another target ('{}'): compile it with "
                        "--target=msp430-none-elf",
                        name, module->getTargetTriple()));
    }
    module->setSourceFileName(name);
    return module;
}

void link_into(llvm::Module& into, ModulePointer from) {
    std::string problem;
    const std::string name = from->getSourceFileName();
    llvm::LLVMContext& context = into.getContext();
    auto before = context.getDiagnosticHandler();
    context.setDiagnosticHandler(std::make_unique<Collector>(problem));
    const bool failed = llvm::Linker::linkModules(into, std::move(from));
    context.setDiagnosticHandler(std::move(before));
    if (!failed) return;
    // "Linking globals named 'main': symbol multiply defined!"
    const std::size_t from_quote = problem.find('\'');
    const std::size_t to_quote = problem.find('\'', from_quote + 1);
    if (to_quote != std::string::npos && problem.find("multiply defined") != std::string::npos) {
        const std::string symbol = problem.substr(from_quote + 1, to_quote - from_quote - 1);
        throw Failed(fmt::format("{}: '{}' is defined in another source too: keep one definition",
                                 name, llvm::demangle(symbol)));
    }
    throw Failed(fmt::format("{}: cannot be linked: {}", name, problem));
}

std::set<std::string> missing_names(std::span<const ModulePointer> modules) {
    std::set<std::string> used;
    std::set<std::string> defined;
    for (const ModulePointer& module : modules) {
        for (const llvm::GlobalValue& value : module->global_values()) {
            if (!value.isDeclaration()) {
                if (!value.hasLocalLinkage()) defined.insert(value.getName().str());
            } else if (!value.use_empty() && !value.getName().starts_with("llvm.")) {
                used.insert(value.getName().str());
            }
        }
    }
    std::erase_if(used, [&](const std::string& name) { return defined.contains(name); });
    return used;
}

std::set<std::string> find_kept(std::span<const ModulePointer> modules,
                                const std::vector<std::string>& keep) {
    std::set<std::string> found;
    for (const std::string& wanted : keep) {
        bool known = false;
        for (const ModulePointer& module : modules) {
            for (llvm::GlobalValue& value : module->global_values()) {
                if (value.isDeclaration()) continue;
                const std::string symbol = value.getName().str();
                const auto [whole, name] = readable_names(symbol);
                if (wanted != symbol && wanted != whole && wanted != name) continue;
                known = true;
                found.insert(symbol);
                if (value.hasLocalLinkage()) {
                    value.setLinkage(llvm::GlobalValue::ExternalLinkage);
                }
            }
        }
        if (!known) {
            throw Failed(fmt::format("'{}' is to be kept, but no source defines it: check the name",
                                     wanted));
        }
    }
    return found;
}

void settle_main(llvm::Module& module) {
    for (const char* mangled : {"_Z4mainv", "_Z4mainiPPc", "_Z4mainiPPKc"}) {
        llvm::Function* function = module.getFunction(mangled);
        if (function != nullptr && module.getFunction("main") == nullptr) function->setName("main");
    }
    llvm::Function* main = module.getFunction("main");
    if (main == nullptr || main->isDeclaration() || main->arg_empty()) return;
    llvm::LLVMContext& context = module.getContext();
    main->setName("main.with_arguments");
    main->setLinkage(llvm::GlobalValue::InternalLinkage);
    auto* type = llvm::FunctionType::get(main->getReturnType(), false);
    auto* plain = llvm::Function::Create(type, llvm::GlobalValue::ExternalLinkage, "main", module);
    plain->copyAttributesFrom(main);
    plain->setAttributes(main->getAttributes().getFnAttrs().hasAttributes()
                             ? llvm::AttributeList::get(
                                   context, llvm::AttributeList::FunctionIndex,
                                   llvm::AttrBuilder(context, main->getAttributes().getFnAttrs()))
                             : llvm::AttributeList());
    llvm::IRBuilder<> builder(llvm::BasicBlock::Create(context, "", plain));
    std::vector<llvm::Value*> zeros;
    for (const llvm::Argument& argument : main->args()) {
        zeros.push_back(llvm::Constant::getNullValue(argument.getType()));
    }
    llvm::CallInst* call = builder.CreateCall(main, zeros);
    if (main->getReturnType()->isVoidTy()) {
        builder.CreateRetVoid();
    } else {
        builder.CreateRet(call);
    }
}

void internalise(llvm::Module& module, const std::set<std::string>& visible) {
    llvm::internalizeModule(module, [&](const llvm::GlobalValue& value) {
        return value.getName() == "main" || is_interrupt(value) ||
               visible.contains(value.getName().str());
    });
    llvm::LoopAnalysisManager loops;
    llvm::FunctionAnalysisManager functions;
    llvm::CGSCCAnalysisManager components;
    llvm::ModuleAnalysisManager modules;
    llvm::PassBuilder builder;
    builder.registerModuleAnalyses(modules);
    builder.registerCGSCCAnalyses(components);
    builder.registerFunctionAnalyses(functions);
    builder.registerLoopAnalyses(loops);
    builder.crossRegisterProxies(loops, functions, components, modules);
    llvm::GlobalDCEPass().run(module, modules);
}

void settle_names(llvm::Module& module) {
    std::vector<llvm::GlobalAlias*> aliases;
    for (llvm::GlobalAlias& alias : module.aliases()) aliases.push_back(&alias);
    for (llvm::GlobalAlias* alias : aliases) {
        alias->replaceAllUsesWith(alias->getAliasee());
        alias->eraseFromParent();
    }
    std::vector<llvm::GlobalValue*> weak;
    for (llvm::GlobalValue& value : module.global_values()) {
        if (value.hasExternalWeakLinkage()) weak.push_back(&value);
    }
    for (llvm::GlobalValue* value : weak) {
        value->replaceAllUsesWith(llvm::Constant::getNullValue(value->getType()));
        value->eraseFromParent();
    }
}

std::vector<std::string> used_names(const llvm::Module& module) {
    llvm::SmallVector<llvm::GlobalValue*, 4> used;
    llvm::collectUsedGlobalVariables(module, used, true);
    llvm::collectUsedGlobalVariables(module, used, false);
    std::vector<std::string> names;
    for (const llvm::GlobalValue* value : used) {
        if (!value->isDeclaration() && !is_interrupt(*value)) {
            names.push_back(value->getName().str());
        }
    }
    return names;
}

}  // namespace toolchain::driver
