// driver.cpp - the steps in their order; see driver.hpp.
#include "toolchain/driver/driver.hpp"

#include <fmt/format.h>
#include <llvm/Demangle/Demangle.h>
#include <llvm/IR/Verifier.h>
#include <llvm/Support/raw_ostream.h>

#include <chrono>
#include <utility>

#include "toolchain/asm/parse.hpp"
#include "toolchain/asm/print.hpp"
#include "toolchain/asm/replace.hpp"
#include "toolchain/asm/verify.hpp"
#include "toolchain/driver/front_end.hpp"
#include "toolchain/driver/join.hpp"
#include "toolchain/driver/resources.hpp"
#include "toolchain/driver/work_folder.hpp"
#include "toolchain/ir/loop_bounds.hpp"
#include "toolchain/ir/select.hpp"

namespace toolchain::driver {
namespace {

/// Measures phases: each lasts until the next one begins.
class Clock {
public:
    explicit Clock(std::vector<PhaseTime>& times) : times_(times) {}
    Clock(const Clock&) = delete;
    Clock& operator=(const Clock&) = delete;
    ~Clock() { stop(); }

    void begin(const char* name) {
        stop();
        times_.push_back({name, 0});
        running_ = true;
        from_ = std::chrono::steady_clock::now();
    }
    void stop() {
        if (!running_) return;
        const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - from_;
        times_.back().seconds = passed.count();
        running_ = false;
    }

private:
    std::vector<PhaseTime>& times_;
    std::chrono::steady_clock::time_point from_{};
    bool running_ = false;
};

/// Mistakes of every step as Failed.
template <class Step>
auto reported(Step step) {
    try {
        return step();
    } catch (const ir::Refused& refused) {
        throw Failed(refused.what());
    } catch (const codegen::Refused& refused) {
        throw Failed(refused.what());
    } catch (const assembly::Error& error) {
        throw Failed(error.what());
    } catch (const std::logic_error& error) {
        throw Failed(fmt::format(
            "internal error: {}: please report it with the source and the options", error.what()));
    }
}

/// One program on its way through LLVM's representation.
class Compilation {
public:
    Compilation(const Request& request, std::vector<PhaseTime>& times)
        : request_(request), clock_(times) {}

    /// Up to the point where only translation is left.
    void to_llvm() {
        if (request_.sources.empty()) throw Failed("no source is given: name a .c or .cpp file");
        read_sources();
        add_library();
        optimise_all();
        join_all();
        prepare();
    }

    codegen::Module to_mir() {
        clock_.begin("translate");
        codegen::Module result = ir::select(*whole_);
        for (const codegen::Function& function : result.functions) {
            const std::string problem = verify(function);
            if (!problem.empty()) {
                throw std::logic_error(result.symbols[function.symbol] + ": " + problem);
            }
        }
        roots_ = used_names(*whole_);
        roots_.insert(roots_.end(), kept_.begin(), kept_.end());
        return result;
    }

    [[nodiscard]] const llvm::Module& llvm_module() const { return *whole_; }
    [[nodiscard]] const std::vector<std::string>& roots() const { return roots_; }
    [[nodiscard]] Clock& clock() { return clock_; }

private:
    void read_sources() {
        clock_.begin("clang");
        const WorkFolder work;
        const auto files = run_front_end(request_, work.path());
        clock_.begin("read");
        ModulePointer together;
        for (std::size_t i = 0; i < files.size(); ++i) {
            const Source& source = request_.sources[i];
            ModulePointer module = read_module(files[i], source.path, context_);
            settle_main(*module);
            if (source.separate) {
                modules_.push_back(std::move(module));
            } else if (together) {
                link_into(*together, std::move(module));
            } else {
                together = std::move(module);
            }
        }
        has_inner_ = together != nullptr;
        if (together) modules_.insert(modules_.begin(), std::move(together));
        kept_ = find_kept(modules_, request_.keep);
    }

    /// Modules that use a function of the library get it, to be inlined where that pays.
    void add_library() {
        const std::set<std::string> missing = missing_names(modules_);
        if (missing.empty()) return;
        Request library;
        library.level = request_.level;
        library.messages = request_.messages;
        for (const Resource& file : library_files()) {
            if (!offers_one(file, missing)) continue;
            library.sources.push_back({std::string(file.name), std::string(file.text)});
        }
        if (library.sources.empty()) return;
        clock_.begin("library");
        const WorkFolder work;
        const auto files = run_front_end(library, work.path());
        for (const ModulePointer& module : modules_) {
            for (std::size_t i = 0; i < files.size(); ++i) {
                add_needed(*module, read_module(files[i], library.sources[i].path, context_),
                           missing);
            }
        }
    }

    /// Whether a line of the source defines one of the functions: "type name(".
    static bool offers_one(const Resource& file, const std::set<std::string>& names) {
        for (const std::string& name : names) {
            if (name.starts_with("__i85_")) continue;  // instructions, see i85.h
            for (const char* before : {" ", "*"}) {
                if (file.text.find(before + name + "(") != std::string_view::npos) return true;
            }
        }
        return false;
    }

    static void add_needed(llvm::Module& into, ModulePointer library,
                           const std::set<std::string>& missing) {
        for (llvm::Function& function : *library) {
            if (function.isDeclaration()) continue;
            const llvm::Function* user = into.getFunction(function.getName());
            const bool wanted = user != nullptr && user->isDeclaration() &&
                                missing.contains(function.getName().str());
            if (wanted) {
                function.setLinkage(llvm::GlobalValue::LinkOnceODRLinkage);
            } else {
                function.deleteBody();
            }
        }
        link_into(into, std::move(library));
    }

    /// What other modules may refer to.
    std::set<std::string> visible_names(std::size_t inner) const {
        std::set<std::string> names = kept_;
        for (std::size_t i = 0; i < modules_.size(); ++i) {
            if (i == inner) continue;
            for (const llvm::GlobalValue& value : modules_[i]->global_values()) {
                names.insert(value.getName().str());
            }
        }
        return names;
    }

    void optimise_all() {
        clock_.begin("optimise");
        if (has_inner_) internalise(*modules_[0], visible_names(0));
        for (const ModulePointer& module : modules_) check_functions(*module);
        for (const ModulePointer& module : modules_) {
            ir::take_loop_bounds(*module);
            ir::optimise(*module, request_.level, request_.steps);
        }
    }

    void join_all() {
        clock_.begin("join");
        whole_ = std::move(modules_[0]);
        for (std::size_t i = 1; i < modules_.size(); ++i) {
            link_into(*whole_, std::move(modules_[i]));
        }
        modules_.clear();
        internalise(*whole_, kept_);
        settle_names(*whole_);
        check_whole(*whole_, request_.allow_constructors);
    }

    void prepare() {
        clock_.begin("prepare");
        const bool fixes = request_.steps.contains(Step::fixed_places);
        if (request_.level != ir::Optimisation::none && fixes) ir::fix_places(*whole_);
        ir::prepare(*whole_, request_.undocumented, request_.steps);
        std::string problem;
        llvm::raw_string_ostream stream(problem);
        if (llvm::verifyModule(*whole_, &stream)) throw std::logic_error(problem);
    }

    const Request& request_;
    Clock clock_;
    llvm::LLVMContext context_;
    std::vector<ModulePointer> modules_;  ///< the first is the inner one, if has_inner_
    bool has_inner_ = false;
    ModulePointer whole_;
    std::set<std::string> kept_;
    std::vector<std::string> roots_;
};

std::vector<assembly::Module> parsed(std::span<const Resource> files) {
    std::vector<assembly::Module> modules;
    for (const Resource& file : files) {
        modules.push_back(assembly::parse(
            file.text, {.file = std::string(file.name), .origin = {}, .routine_comments = true}));
        modules.back().name = file.name;
    }
    return modules;
}

std::vector<assembly::Module> runtime_modules(const Request& request) {
    std::vector<assembly::Module> modules = parsed(runtime_files());
    if (request.undocumented) assembly::replace_sections(modules, parsed(undocumented_files()));
    if (request.table_multiply) assembly::replace_sections(modules, parsed(table_files()));
    if (request.small_runtime) assembly::replace_sections(modules, parsed(small_files()));
    return modules;
}

/// LLVM's demangler knows C++20's names, which that of an older C++ library does not.
void add_titles(assembly::Module& module) {
    for (assembly::Section& section : module.sections) {
        if (!section.title.empty() || !section.name.starts_with("_Z")) continue;
        std::string title = llvm::demangle(section.name);
        if (title != section.name) section.title = std::move(title);
    }
}

codegen::Compiled generate(const Request& request, codegen::Module module,
                           const std::vector<std::string>& roots) {
    const codegen::SymbolId main = module.intern("main");
    if (module.find(main) == nullptr) {
        throw Failed("no source defines 'main': it is where the program starts");
    }
    codegen::CompileOptions options;
    options.allow_recursion = request.allow_recursion;
    options.search = request.level != ir::Optimisation::none;
    options.search_budget = request.search_budget;
    options.byte_cost = request.byte_cost;
    options.undocumented = request.undocumented;
    options.steps = request.steps;
    for (const std::string& root : roots) {
        const auto symbol = module.symbol_ids.find(root);
        if (symbol != module.symbol_ids.end() && module.find(symbol->second) != nullptr) {
            options.roots.push_back(root);
        }
    }
    codegen::Compiled compiled =
        codegen::compile(std::move(module), runtime_modules(request), options);
    add_titles(compiled.module);
    return compiled;
}

void check_ranges(const Request& request) {
    const assembly::AddressRange& rom = request.rom;
    const assembly::AddressRange& ram = request.ram;
    if (rom.last < ram.first || ram.last < rom.first) return;
    throw Failed(
        fmt::format("ROM {:04X}H-{:04X}H and RAM {:04X}H-{:04X}H overlap: correct --rom "
                    "or --ram",
                    rom.first, rom.last, ram.first, ram.last));
}

assembly::LinkOptions link_options(const Request& request, const codegen::Compiled& compiled,
                                   const std::vector<std::string>& roots) {
    assembly::LinkOptions options;
    options.rom = request.rom;
    options.ram = request.ram;
    options.roots = roots;
    options.vectors = compiled.vectors;
    options.vector_base = request.vector_base;
    options.forward_to = request.forward_to;
    options.startup = assembly::StartupOptions{"main", compiled.constructors};
    const uint32_t known = compiled.stack_known ? compiled.stack_bytes : kStackBytesOfRecursion;
    options.stack_size = request.stack_bytes.value_or(known);
    if (compiled.stack_known && options.stack_size < compiled.stack_bytes) {
        throw Failed(
            fmt::format("the stack has {} bytes, but calls and interrupts take up to {}: "
                        "raise --stack, or leave it out",
                        options.stack_size, compiled.stack_bytes));
    }
    return options;
}

assembly::Program link_program(const Request& request, codegen::Compiled& compiled,
                               const std::vector<std::string>& roots) {
    std::vector<assembly::Module> modules;
    modules.push_back(std::move(compiled.module));
    for (assembly::Module& module : runtime_modules(request)) {
        modules.push_back(std::move(module));
    }
    assembly::Program program =
        assembly::link(std::move(modules), link_options(request, compiled, roots));
    const auto problems = assembly::verify(program, {.allow_undocumented = request.undocumented});
    if (!problems.empty()) throw std::logic_error(problems.front().message());
    return program;
}

}  // namespace

Result compile_program(const Request& request) {
    return reported([&] {
        check_ranges(request);
        Result result;
        Compilation compilation(request, result.times);
        compilation.to_llvm();
        codegen::Module module = compilation.to_mir();
        Clock& clock = compilation.clock();
        clock.begin("generate");
        result.compiled = generate(request, std::move(module), compilation.roots());
        clock.begin("link");
        result.program = link_program(request, result.compiled, compilation.roots());
        clock.stop();
        return result;
    });
}

codegen::Module compile_to_mir(const Request& request) {
    return reported([&] {
        std::vector<PhaseTime> times;
        Compilation compilation(request, times);
        compilation.to_llvm();
        return compilation.to_mir();
    });
}

std::string compile_to_text(const Request& request, Text stage) {
    return reported([&]() -> std::string {
        std::vector<PhaseTime> times;
        Compilation compilation(request, times);
        compilation.to_llvm();
        if (stage == Text::llvm) {
            std::string text;
            llvm::raw_string_ostream stream(text);
            compilation.llvm_module().print(stream, nullptr);
            return text;
        }
        codegen::Module module = compilation.to_mir();
        if (stage == Text::mir) return print(module);
        return assembly::source_text(
            generate(request, std::move(module), compilation.roots()).module);
    });
}

}  // namespace toolchain::driver
