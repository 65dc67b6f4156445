// fix_places.cpp - pointer parameters that always hold the same address; see prepare.hpp.
// Why          frames are static, so a caller's variable has a fixed address, and its callee may
//              know it: `LDA x` is 13 T-states and 3 bytes, a field behind a pointer about 40
//              and 8.
// Invariant    a function that can be active twice keeps its variables: see find_recursive().
// Depends on   libLLVM 19 (Passes).
#include <fmt/format.h>
#include <llvm/Analysis/GlobalsModRef.h>
#include <llvm/IR/Constants.h>
#include <llvm/IR/IRBuilder.h>
#include <llvm/IR/InstIterator.h>
#include <llvm/IR/IntrinsicInst.h>
#include <llvm/IR/Module.h>
#include <llvm/Passes/PassBuilder.h>
#include <llvm/Transforms/IPO/DeadArgumentElimination.h>
#include <llvm/Transforms/IPO/FunctionAttrs.h>
#include <llvm/Transforms/IPO/SCCP.h>
#include <llvm/Transforms/InstCombine/InstCombine.h>
#include <llvm/Transforms/Scalar/EarlyCSE.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "toolchain/ir/analyses.hpp"
#include "toolchain/ir/prepare.hpp"

namespace toolchain::ir {

namespace {

/// A variable, of a frame or global, plus bytes. Without a variable: several places.
struct Place {
    llvm::Value* base = nullptr;
    int64_t offset = 0;

    bool operator==(const Place&) const = default;
};

/// The function that a call names, if it can be changed together with all its calls.
llvm::Function* changeable(llvm::Function& function) {
    const bool known = function.hasLocalLinkage() && !function.isDeclaration() &&
                       !function.isVarArg() && !function.hasFnAttribute("interrupt");
    if (!known) return nullptr;
    for (const llvm::Use& use : function.uses()) {
        const auto* call = llvm::dyn_cast<llvm::CallBase>(use.getUser());
        if (call == nullptr || !call->isCallee(&use)) return nullptr;
    }
    return &function;
}

class Fixer {
public:
    explicit Fixer(llvm::Module& module) : module_(module), layout_(module.getDataLayout()) {}

    /// @return whether something has changed
    bool run() {
        find_recursive();
        find_places();
        if (places_.empty()) return false;
        for (const auto& [argument, place] : places_) replace(*argument, *place);
        for (const auto& [variable, global] : globals_) remove(*variable, *global);
        return true;
    }

private:
    // -- Recursion -------------------------------------------------------------------------------

    // A call through a pointer may come to any function whose address is taken.
    [[nodiscard]] std::set<llvm::Function*> callees(llvm::Function& function) const {
        std::set<llvm::Function*> result;
        for (llvm::Instruction& instruction : llvm::instructions(function)) {
            auto* call = llvm::dyn_cast<llvm::CallBase>(&instruction);
            if (call == nullptr || call->isInlineAsm()) continue;
            if (llvm::Function* callee = call->getCalledFunction()) {
                if (!callee->isDeclaration()) result.insert(callee);
                continue;
            }
            for (llvm::Function& other : module_) {
                if (!other.isDeclaration() && other.hasAddressTaken()) result.insert(&other);
            }
        }
        return result;
    }

    void find_recursive() {
        std::map<llvm::Function*, std::set<llvm::Function*>> below;
        for (llvm::Function& function : module_) {
            if (!function.isDeclaration()) below[&function] = callees(function);
        }
        for (auto& [function, direct] : below) {
            std::vector<llvm::Function*> open(direct.begin(), direct.end());
            std::set<llvm::Function*> seen = direct;
            while (!open.empty()) {
                llvm::Function* next = open.back();
                open.pop_back();
                for (llvm::Function* callee : below[next]) {
                    if (seen.insert(callee).second) open.push_back(callee);
                }
            }
            if (seen.contains(function)) recursive_.insert(function);
        }
    }

    // -- Places ----------------------------------------------------------------------------------

    /// Nothing: not known yet, the argument it depends on has no place so far.
    std::optional<Place> place_of(llvm::Value* value) const {
        llvm::APInt bytes(layout_.getIndexTypeSizeInBits(value->getType()), 0);
        llvm::Value* base =
            value->stripAndAccumulateConstantOffsets(layout_, bytes, /*AllowNonInbounds=*/true);
        const int64_t offset = bytes.getSExtValue();
        if (auto* argument = llvm::dyn_cast<llvm::Argument>(base)) {
            const auto found = places_.find(argument);
            if (found == places_.end()) return Place{};
            if (!found->second) return std::nullopt;
            if (found->second->base == nullptr) return Place{};
            return Place{found->second->base, found->second->offset + offset};
        }
        if (auto* variable = llvm::dyn_cast<llvm::AllocaInst>(base)) {
            const bool fixed = variable->isStaticAlloca() &&
                               variable->getAllocationSize(layout_).has_value() &&
                               !recursive_.contains(variable->getFunction());
            return fixed ? Place{variable, offset} : Place{};
        }
        if (llvm::isa<llvm::GlobalVariable>(base)) return Place{base, offset};
        return Place{};
    }

    /// What all calls that are understood so far give. Nothing: none is.
    std::optional<Place> common_place(const llvm::Argument& argument) const {
        std::optional<Place> common;
        for (const llvm::User* user : argument.getParent()->users()) {
            const auto* call = llvm::cast<llvm::CallBase>(user);
            const auto place = place_of(call->getArgOperand(argument.getArgNo()));
            if (!place) continue;
            if (common && *common != *place) return Place{};
            common = place;
        }
        return common;
    }

    // From "not known" downwards to one place or to several, until nothing changes.
    void find_places() {
        for (llvm::Function& function : module_) {
            if (changeable(function) == nullptr || function.use_empty()) continue;
            for (llvm::Argument& argument : function.args()) {
                const bool is_pointer = argument.getType()->isPointerTy();
                if (is_pointer && !argument.hasByValAttr()) places_[&argument] = std::nullopt;
            }
        }
        for (bool changed = true; changed;) {
            changed = false;
            for (auto& [argument, place] : places_) {
                const auto now = common_place(*argument);
                if (now == place) continue;
                place = now;
                changed = true;
            }
        }
        std::erase_if(places_, [](const auto& entry) {
            return !entry.second || entry.second->base == nullptr || entry.first->use_empty();
        });
    }

    // -- Changes ---------------------------------------------------------------------------------

    llvm::GlobalVariable& global_of(llvm::AllocaInst& variable) {
        llvm::GlobalVariable*& global = globals_[&variable];
        if (global != nullptr) return *global;
        const std::string function = variable.getFunction()->getName().str();
        auto* type = llvm::ArrayType::get(llvm::Type::getInt8Ty(module_.getContext()),
                                          variable.getAllocationSize(layout_)->getFixedValue());
        global = new llvm::GlobalVariable(
            module_, type, false, llvm::GlobalValue::InternalLinkage, llvm::UndefValue::get(type),
            fmt::format("{}@frame.{}", function, variable.getName().str()));
        global->setAlignment(variable.getAlign());
        global->addAttribute(kFrameAttribute, function);
        return *global;
    }

    void replace(llvm::Argument& argument, const Place& place) {
        auto* variable = llvm::dyn_cast<llvm::AllocaInst>(place.base);
        llvm::Constant* base =
            variable != nullptr ? &global_of(*variable) : llvm::cast<llvm::Constant>(place.base);
        auto* byte = llvm::Type::getInt8Ty(module_.getContext());
        auto* offset =
            llvm::ConstantInt::getSigned(layout_.getIndexType(base->getType()), place.offset);
        argument.replaceAllUsesWith(
            place.offset == 0 ? base : llvm::ConstantExpr::getGetElementPtr(byte, base, offset));
    }

    static void remove(llvm::AllocaInst& variable, llvm::GlobalVariable& global) {
        std::vector<llvm::Instruction*> markers;
        for (llvm::User* user : variable.users()) {
            auto* intrinsic = llvm::dyn_cast<llvm::IntrinsicInst>(user);
            if (intrinsic != nullptr && intrinsic->isLifetimeStartOrEnd()) {
                markers.push_back(intrinsic);
            }
        }
        for (llvm::Instruction* marker : markers) marker->eraseFromParent();
        variable.replaceAllUsesWith(&global);
        variable.eraseFromParent();
    }

    llvm::Module& module_;
    const llvm::DataLayout& layout_;
    std::set<llvm::Function*> recursive_;
    std::map<llvm::Argument*, std::optional<Place>> places_;
    std::map<llvm::AllocaInst*, llvm::GlobalVariable*> globals_;
};

/// "Touches only what its arguments point to" is no longer true: such promises are made anew.
void forget_effects(llvm::Module& module) {
    for (llvm::Function& function : module) {
        if (function.isDeclaration()) continue;
        function.removeFnAttr(llvm::Attribute::Memory);
        for (llvm::Instruction& instruction : llvm::instructions(function)) {
            auto* call = llvm::dyn_cast<llvm::CallBase>(&instruction);
            if (call == nullptr || llvm::isa<llvm::IntrinsicInst>(call)) continue;
            call->removeFnAttr(llvm::Attribute::Memory);
        }
    }
}

void tidy_up(llvm::Module& module) {
    llvm::PassBuilder builder;
    llvm::ModulePassManager passes;
    passes.addPass(llvm::IPSCCPPass());
    passes.addPass(llvm::DeadArgumentEliminationPass());
    passes.addPass(
        llvm::createModuleToPostOrderCGSCCPassAdaptor(llvm::PostOrderFunctionAttrsPass()));
    passes.addPass(llvm::RequireAnalysisPass<llvm::GlobalsAA, llvm::Module>());
    llvm::FunctionPassManager each;
    each.addPass(llvm::InstCombinePass());
    each.addPass(llvm::EarlyCSEPass(true));
    passes.addPass(llvm::createModuleToFunctionPassAdaptor(std::move(each)));
    ModuleAnalyses(builder).run(std::move(passes), module);
}

}  // namespace

void fix_places(llvm::Module& module) {
    if (!Fixer(module).run()) return;
    forget_effects(module);
    tidy_up(module);
}

}  // namespace toolchain::ir
