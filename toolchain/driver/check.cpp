// check.cpp - what a joined module may not contain, named with file and line; see join.hpp.
#include <fmt/format.h>
#include <llvm/ADT/StringExtras.h>
#include <llvm/Demangle/Demangle.h>
#include <llvm/IR/DebugInfoMetadata.h>
#include <llvm/IR/InstIterator.h>
#include <llvm/IR/Instructions.h>

#include <algorithm>
#include <array>
#include <map>

#include "toolchain/driver/join.hpp"

namespace toolchain::driver {
namespace {

constexpr std::size_t kMostShown = 10;

/// Functions that select() knows without a definition.
bool is_built_in(llvm::StringRef name) {
    if (name.starts_with("llvm.") || name.starts_with("__i85_")) return true;
    static constexpr std::array<llvm::StringLiteral, 3> kMemory = {"__memcpy", "__memmove",
                                                                   "__memset"};
    return std::ranges::find(kMemory, name) != kMemory.end();
}

/// "file:line" of a function, or its source. Functions that clang makes have no line of their own.
std::string place_of(const llvm::Function& function) {
    const llvm::DISubprogram* whole = function.getSubprogram();
    if (whole == nullptr) return function.getParent()->getSourceFileName();
    unsigned line = whole->getLine();
    for (const llvm::Instruction& instruction : llvm::instructions(function)) {
        if (line != 0) break;
        if (const llvm::DebugLoc& place = instruction.getDebugLoc()) line = place.getLine();
    }
    return fmt::format("{}:{}", whole->getFilename().str(), line);
}

/// "file:line" of an instruction. Line 0 marks what clang adds by itself.
std::string place_of(const llvm::Instruction& instruction) {
    const llvm::DebugLoc& place = instruction.getDebugLoc();
    if (!place || place.getLine() == 0) return place_of(*instruction.getFunction());
    return fmt::format("{}:{}", place->getFilename().str(), place.getLine());
}

/// "file:line" of the statement that an instruction was inlined into.
std::string outer_place_of(const llvm::Instruction& instruction) {
    std::string outermost;
    for (const llvm::DILocation* place = instruction.getDebugLoc().get(); place != nullptr;
         place = place->getInlinedAt()) {
        if (place->getLine() == 0) continue;
        outermost = fmt::format("{}:{}", place->getFilename().str(), place->getLine());
    }
    return outermost.empty() ? place_of(*instruction.getFunction()) : outermost;
}

std::string first_place_in(const llvm::Function& function) {
    for (const llvm::Instruction& instruction : llvm::instructions(function)) {
        if (instruction.getDebugLoc()) return outer_place_of(instruction);
    }
    return place_of(function);
}

/// The name in the source. The optimiser makes "object.0", "object.1" of an object's members.
std::string source_name(llvm::StringRef symbol) {
    const auto [object, member] = symbol.rsplit('.');
    const bool is_member = !member.empty() && llvm::all_of(member, llvm::isDigit);
    return llvm::demangle((is_member ? object : symbol).str());
}

std::string place_of(const llvm::GlobalObject& object) {
    const auto* function = llvm::dyn_cast<llvm::Function>(&object);
    return function != nullptr ? place_of(*function) : object.getParent()->getSourceFileName();
}

/// A place where a constant is used, through expressions and initial values.
std::string place_of_use(const llvm::Constant& constant, unsigned depth = 0) {
    constexpr unsigned kDeepest = 8;
    for (const llvm::User* user : constant.users()) {
        if (const auto* instruction = llvm::dyn_cast<llvm::Instruction>(user)) {
            return place_of(*instruction);
        }
        if (const auto* variable = llvm::dyn_cast<llvm::GlobalVariable>(user)) {
            return fmt::format("{}: in '{}'", variable->getParent()->getSourceFileName(),
                               llvm::demangle(variable->getName().str()));
        }
        if (const auto* other = llvm::dyn_cast<llvm::Constant>(user)) {
            if (depth < kDeepest) return place_of_use(*other, depth + 1);
        }
    }
    return constant.getName().str();
}

/// What to do about a name that nobody defines.
std::string remedy(llvm::StringRef name) {
    if (name.starts_with("__atomic_") || name.starts_with("__sync_")) {
        return "there are no atomic operations: let __i85_di() and __i85_ei() protect the access";
    }
    if (name.starts_with("_Zn") || name == "malloc" || name == "calloc" || name == "realloc" ||
        name == "free") {
        return "there is no heap: use objects with static storage";
    }
    if (name.starts_with("__cxa_") || name.starts_with("_Unwind")) {
        return "this feature of C++ needs a library that the 8085 has not";
    }
    return "add the source that defines it, or correct the name";
}

class Checker {
public:
    explicit Checker(const llvm::Module& module) : module_(module) {}

    void check_functions() {
        check_assembly();
        check_sections();
        check_interrupts();
        check_calls();
    }

    void check_whole(bool allow_constructors) {
        check_missing();
        if (!allow_constructors) check_constructors();
    }

    /// @errors Failed if there are mistakes
    void finish() const {
        if (mistakes_.empty()) return;
        std::string text;
        for (std::size_t i = 0; i < std::min(mistakes_.size(), kMostShown); ++i) {
            text += (i == 0 ? "" : "\n") + mistakes_[i];
        }
        if (mistakes_.size() > kMostShown) {
            text += fmt::format("\nand {} more", mistakes_.size() - kMostShown);
        }
        throw Failed(text);
    }

private:
    void add(std::string text) { mistakes_.push_back(std::move(text)); }

    void check_assembly() {
        if (module_.getModuleInlineAsm().empty()) return;
        add(fmt::format("{}: assembly outside of functions is not supported: use i85.h",
                        module_.getSourceFileName()));
    }

    void check_sections() {
        for (const llvm::GlobalObject& object : module_.global_objects()) {
            if (!object.hasSection() || object.getName().starts_with("llvm.")) continue;
            add(
                fmt::format("{}: '{}' is to be in section '{}', but sections have no names here: "
                            "leave the attribute out",
                            place_of(object), llvm::demangle(object.getName().str()),
                            object.getSection().str()));
        }
    }

    void check_missing() {
        for (const llvm::GlobalValue& value : module_.global_values()) {
            if (llvm::isa<llvm::GlobalIFunc>(value)) {
                add(fmt::format("{}: '{}' is chosen at load time (ifunc): call one function",
                                module_.getSourceFileName(), value.getName().str()));
            }
            if (!value.isDeclaration() || value.use_empty() || is_built_in(value.getName())) {
                continue;
            }
            const std::string symbol = value.getName().str();
            add(fmt::format("{}: '{}' is used but not defined: {}", place_of_use(value),
                            llvm::demangle(symbol), remedy(symbol)));
        }
    }

    void check_interrupts() {
        std::map<int, std::string> vectors;
        for (const llvm::Function& function : module_) {
            if (function.isDeclaration() || !function.hasFnAttribute("interrupt")) continue;
            const std::string name = llvm::demangle(function.getName().str());
            int vector = 0;
            function.getFnAttribute("interrupt").getValueAsString().getAsInteger(10, vector);
            static constexpr std::array<int, 11> kVectors = {0x08, 0x10, 0x18, 0x20, 0x24, 0x28,
                                                             0x2C, 0x30, 0x34, 0x38, 0x3C};
            if (std::ranges::find(kVectors, vector) == kVectors.end()) {
                add(
                    fmt::format("{}: '{}': the 8085 has no interrupt at {:02X}H: take one of "
                                "i85.h, such as I85_RST_75",
                                place_of(function), name, vector));
            }
            const auto [other, is_new] = vectors.emplace(vector, name);
            if (!is_new) {
                add(fmt::format("{}: '{}' and '{}' both serve the interrupt at {:02X}H: keep one",
                                place_of(function), other->second, name, vector));
            }
            for (const llvm::User* user : function.users()) {
                const auto* call = llvm::dyn_cast<llvm::CallBase>(user);
                if (call == nullptr || call->getCalledOperand() != &function) continue;
                add(
                    fmt::format("{}: the interrupt function '{}' is called: call a function that "
                                "both share",
                                place_of(*call), name));
            }
        }
    }

    /// With opaque pointers a call of another type looks like one through a pointer.
    void check_calls() {
        for (const llvm::Function& function : module_) {
            for (const llvm::Instruction& instruction : llvm::instructions(function)) {
                const auto* call = llvm::dyn_cast<llvm::CallBase>(&instruction);
                if (call == nullptr) continue;
                const auto* callee = llvm::dyn_cast<llvm::Function>(call->getCalledOperand());
                if (callee == nullptr || callee->getFunctionType() == call->getFunctionType()) {
                    continue;
                }
                add(
                    fmt::format("{}: '{}' is called with other parameters or another result than "
                                "it is defined with: declare it as it is",
                                place_of(*call), llvm::demangle(callee->getName().str())));
            }
        }
    }

    void check_constructors() {
        const llvm::GlobalVariable* list = module_.getGlobalVariable("llvm.global_ctors");
        if (list == nullptr || !list->hasInitializer()) return;
        for (const llvm::Use& entry : list->getInitializer()->operands()) {
            const auto* fields = llvm::dyn_cast<llvm::ConstantStruct>(entry);
            if (fields == nullptr) continue;
            const auto* function = llvm::dyn_cast<llvm::Function>(fields->getOperand(1));
            if (function == nullptr) continue;
            const std::size_t before = mistakes_.size();
            describe_constructor(*function, 0);
            if (mistakes_.size() != before) continue;
            add(
                fmt::format("{}: this runs before main, and --no-constructors forbids it: call it "
                            "from main",
                            first_place_in(*function)));
        }
    }

    /// The functions that clang makes call one another; the innermost ones build objects.
    void describe_constructor(const llvm::Function& function, unsigned depth) {
        for (const llvm::Instruction& instruction : llvm::instructions(function)) {
            const auto* call = llvm::dyn_cast<llvm::CallBase>(&instruction);
            const llvm::Function* callee = call == nullptr ? nullptr : call->getCalledFunction();
            if (callee != nullptr && callee->getName().starts_with("__cxx_global_var_init") &&
                depth < 4) {
                describe_constructor(*callee, depth + 1);
                continue;
            }
            for (const llvm::Use& operand : instruction.operands()) {
                const llvm::Value* value = operand->stripInBoundsOffsets();
                const auto* variable = llvm::dyn_cast<llvm::GlobalVariable>(value);
                if (variable == nullptr || variable->isConstant()) continue;
                if (llvm::isa<llvm::LoadInst>(instruction)) continue;
                const std::string name = source_name(variable->getName());
                if (name.starts_with("guard variable") || !constructed_.insert(name).second) {
                    continue;
                }
                add(
                    fmt::format("{}: '{}' is constructed at run time, and --no-constructors "
                                "forbids it: make it constinit",
                                outer_place_of(instruction), name));
            }
        }
    }

    const llvm::Module& module_;
    std::vector<std::string> mistakes_;
    std::set<std::string> constructed_;
};

}  // namespace

void check_functions(const llvm::Module& module) {
    Checker checker(module);
    checker.check_functions();
    checker.finish();
}

void check_whole(const llvm::Module& module, bool allow_constructors) {
    Checker checker(module);
    checker.check_functions();
    checker.check_whole(allow_constructors);
    checker.finish();
}

}  // namespace toolchain::driver
