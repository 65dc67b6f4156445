// compile_with.cpp - see compile.hpp. The steps in their order: calls, checks, code from the leaves
// up, sections, copies for interrupts, frames, stack.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <functional>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>
#include <utility>

#include "toolchain/codegen/abi.hpp"
#include "toolchain/codegen/call_graph.hpp"
#include "toolchain/codegen/checks.hpp"
#include "toolchain/codegen/compile.hpp"
#include "toolchain/codegen/contexts.hpp"
#include "toolchain/codegen/copies.hpp"
#include "toolchain/codegen/emit.hpp"
#include "toolchain/codegen/lower_calls.hpp"
#include "toolchain/codegen/names.hpp"
#include "toolchain/codegen/overlay.hpp"
#include "toolchain/codegen/routine_stack.hpp"

namespace toolchain::codegen {

namespace {

constexpr uint32_t kReturnAddress = 2;

Module lowered(Module module, const Steps& steps) {
    lower_calls(module, steps.contains(Step::narrow_calls));
    for (const Function& function : module.functions) {
        const std::string problem = verify(function);
        if (problem.empty()) continue;
        throw std::logic_error(
            fmt::format("{} behind lower_calls: {}", module.symbols[function.symbol], problem));
    }
    return module;
}

class Compiler {
public:
    Compiler(const Generator& generator, Module module, std::span<const assembly::Module> runtime,
             const CompileOptions& options)
        : generator_(generator),
          options_(options),
          runtime_(runtime),
          module_(lowered(std::move(module), options.steps)),
          graph_(module_),
          names_(module_),
          routine_stack_(runtime) {}

    Compiled run() {
        refuse(call_refusals(module_, graph_, options_.allow_recursion));
        contexts_ = find_contexts(module_, graph_, main_roots());
        owner_ = owners(contexts_, module_.functions.size());
        generate_all();
        make_sections();
        std::vector<std::string> refusals;
        copies_ =
            make_copies({module_, names_, graph_, contexts_, runtime_}, result_.module, refusals);
        refuse(refusals);
        find_stack();
        place_frames();
        add_notes();
        finish();
        return std::move(result_);
    }

private:
    static void refuse(const std::vector<std::string>& refusals) {
        if (!refusals.empty()) throw Refused(fmt::format("{}", fmt::join(refusals, "\n")));
    }

    [[nodiscard]] const std::string& name(std::size_t function) const {
        return names_.of(module_.functions[function].symbol);
    }

    std::vector<std::size_t> main_roots() {
        std::vector<std::size_t> roots;
        std::vector<std::string> missing;
        const auto add = [&](const std::string& function) {
            const auto symbol = module_.symbol_ids.find(function);
            const std::size_t index = symbol == module_.symbol_ids.end()
                                          ? CallGraph::kNoFunction
                                          : graph_.index_of(symbol->second);
            if (index == CallGraph::kNoFunction) {
                missing.push_back(fmt::format("no function '{}' is defined", function));
            } else if (std::ranges::find(roots, index) == roots.end()) {
                roots.push_back(index);
            }
        };
        add(options_.main);
        if (!options_.roots.empty()) missing.clear();  // entered from elsewhere
        for (const std::string& root : options_.roots) add(root);
        for (const SymbolId constructor : module_.constructors) {
            add(module_.symbols[constructor]);
            result_.constructors.push_back(names_.of(constructor));
        }
        refuse(missing);
        return roots;
    }

    // -- Code ------------------------------------------------------------------------------------

    [[nodiscard]] bool is_kept(std::size_t function) const {
        return owner_[function] != kNoContext;
    }

    // Functions whose callees are done do not wait for one another: a level at a time, on all
    // processors. The result does not depend on who is first.
    void generate_all() {
        code_.resize(module_.functions.size());
        done_.assign(module_.functions.size(), false);
        for (const std::vector<std::size_t>& level : levels()) {
            std::atomic<std::size_t> next = 0;
            std::exception_ptr failure;
            std::mutex failing;
            const auto work = [&] {
                for (std::size_t i = next++; i < level.size(); i = next++) {
                    try {
                        generate_one(level[i]);
                    } catch (...) {
                        const std::scoped_lock lock(failing);
                        if (!failure) failure = std::current_exception();
                    }
                }
            };
            const std::size_t most = std::max(1U, std::thread::hardware_concurrency());
            std::vector<std::jthread> workers;
            for (std::size_t i = 1; i < std::min(most, level.size()); ++i) {
                workers.emplace_back(work);
            }
            work();
            workers.clear();
            if (failure) std::rethrow_exception(failure);
            for (const std::size_t index : level) done_[index] = true;
        }
    }

    /// Functions by the longest way down to a leaf; those that recurse together have one level.
    [[nodiscard]] std::vector<std::vector<std::size_t>> levels() const {
        std::map<std::size_t, std::size_t> height;  // by group
        std::vector<std::vector<std::size_t>> result;
        const auto& order = graph_.bottom_up();
        for (std::size_t at = 0; at < order.size();) {
            const std::size_t group = graph_.group(order[at]);
            const std::size_t first = at;
            std::size_t level = 0;
            for (; at < order.size() && graph_.group(order[at]) == group; ++at) {
                for (const GraphEdge& edge : graph_.callees(order[at])) {
                    const std::size_t callee = graph_.group(edge.callee);
                    if (callee != group) level = std::max(level, height.at(callee) + 1);
                }
            }
            height[group] = level;
            result.resize(std::max(result.size(), level + 1));
            for (std::size_t i = first; i < at; ++i) {
                if (is_kept(order[i])) result[level].push_back(order[i]);
            }
        }
        return result;
    }

    void generate_one(std::size_t index) {
        GenerateOptions options;
        options.search = options_.search;
        options.search_budget = options_.search_budget;
        options.byte_cost = options_.byte_cost;
        options.undocumented = options_.undocumented;
        options.steps = options_.steps;
        options.clobbers_of = [this](SymbolId symbol) { return clobbers_of(symbol); };
        set_pointer_clobbers(module_.functions[index]);
        code_[index] = generator_(module_, module_.functions[index], options);
    }

    /// What is not made yet comes back through recursion, or is unknown.
    [[nodiscard]] RegisterSet clobbers_of(SymbolId symbol) const {
        const std::size_t index = graph_.index_of(symbol);
        if (index == CallGraph::kNoFunction || !done_[index]) return kAllRegisters;
        return code_[index].clobbers;
    }

    void set_pointer_clobbers(Function& function) const {
        for (Block& block : function.blocks) {
            for (Operation& operation : block.operations) {
                if (operation.opcode != Opcode::call_indirect) continue;
                const auto& targets = graph_.targets(operation.signature);
                operation.clobbers = targets.empty() ? kAllRegisters : RegisterSet{0};
                for (const std::size_t target : targets) {
                    operation.clobbers |= clobbers_of(module_.functions[target].symbol);
                }
            }
        }
    }

    void make_sections() {
        assembly::Module& out = result_.module;
        out.name = "program";
        out.files = module_.files;
        for (std::size_t i = 0; i < module_.functions.size(); ++i) {
            if (!is_kept(i)) continue;
            const Function& function = module_.functions[i];
            out.sections.push_back(code_section(module_, names_, function, code_[i]));
            assembly::Section frame = frame_section(names_, function, code_[i]);
            if (section_size(frame) != 0) out.sections.push_back(std::move(frame));
        }
        // The most aligned ones first: then no byte is lost between them.
        std::vector<const Variable*> variables;
        for (const Variable& variable : module_.variables) variables.push_back(&variable);
        std::ranges::stable_sort(variables, std::greater{}, &Variable::alignment);
        for (const Variable* variable : variables) {
            out.sections.push_back(variable_section(module_, names_, *variable));
        }
    }

    // -- Frames ----------------------------------------------------------------------------------

    // The main program's frames first, behind them a region for each interrupt.
    void place_frames() {
        std::vector<uint32_t> sizes(module_.functions.size(), 0);
        std::vector<uint32_t> alignments(module_.functions.size(), 1);
        for (std::size_t i = 0; i < sizes.size(); ++i) {
            if (!is_kept(i)) continue;
            const FrameLayout layout = frame_layout(module_.functions[i], code_[i]);
            sizes[i] = layout.size;
            alignments[i] = layout.alignment;
        }
        std::map<std::string, uint32_t> offsets;  // by name of the frame's function
        uint32_t start = 0;
        for (std::size_t context = 0; context < contexts_.size(); ++context) {
            const Context& here = contexts_[context];
            const Overlay overlay = overlay_frames(graph_, here.roots, sizes, start, alignments);
            start = overlay.end;
            for (std::size_t i = 0; i < sizes.size(); ++i) {
                if (!here.reached[i]) continue;
                const bool is_copy = copies_[context].functions.contains(i);
                if (!is_copy && owner_[i] != context) continue;
                const std::string instance = name(i) + (is_copy ? here.suffix : "");
                offsets[instance] = overlay.offsets[i];
                report(i, instance, sizes[i], overlay.offsets[i]);
            }
        }
        for (assembly::Section& section : result_.module.sections) {
            if (section.kind != assembly::SectionKind::frame) continue;
            section.frame_offset = offsets.at(section.function);
        }
    }

    void report(std::size_t function, const std::string& instance, uint32_t size, uint32_t offset) {
        FunctionReport report;
        report.name = instance;
        report.frame_bytes = size;
        report.frame_offset = offset;
        report.stack_bytes = stack_[function];
        report.recursive = graph_.is_recursive(function);
        std::set<std::string> callees;
        for (const GraphEdge& edge : graph_.callees(function)) callees.insert(name(edge.callee));
        for (const CallSite& site : code_[function].calls) {
            if (site.symbol != kNone) callees.insert(names_.of(site.symbol));
        }
        report.callees.assign(callees.begin(), callees.end());
        result_.functions.push_back(std::move(report));
    }

    // -- Stack -----------------------------------------------------------------------------------

    void find_stack() {
        stack_.assign(module_.functions.size(), 0);
        unbounded_.assign(module_.functions.size(), false);
        for (const std::size_t index : graph_.bottom_up()) {
            if (!is_kept(index)) continue;
            stack_[index] = stack_of(index);
            unbounded_[index] =
                graph_.is_recursive(index) ||
                std::ranges::any_of(graph_.callees(index),
                                    [&](const GraphEdge& edge) { return unbounded_[edge.callee]; });
            result_.stack_known = result_.stack_known && !unbounded_[index];
        }
    }

    [[nodiscard]] uint32_t stack_of(std::size_t function) {
        uint32_t most = code_[function].stack_bytes;
        for (const CallSite& site : code_[function].calls) {
            uint32_t below = 0;
            if (site.signature != kNone) {
                for (const std::size_t target : graph_.targets(site.signature)) {
                    below = std::max(below, activation(function, target));
                }
            } else {
                const std::size_t callee = graph_.index_of(site.symbol);
                below = callee == CallGraph::kNoFunction ? routine_stack_.of(names_.of(site.symbol))
                                                         : activation(function, callee);
            }
            most = std::max(most, site.pushed + (site.jumps ? 0 : kReturnAddress) + below);
        }
        return most;
    }

    /// What a call adds; one that comes back adds its own activation, which is not counted here.
    [[nodiscard]] uint32_t activation(std::size_t caller, std::size_t callee) const {
        return graph_.group(caller) == graph_.group(callee) ? 0 : stack_[callee];
    }

    /// The main program at its deepest, and every interrupt once on top of it.
    void total_stack() {
        uint32_t deepest = 0;
        for (const std::size_t root : contexts_[0].roots) {
            deepest = std::max(deepest, kReturnAddress + stack_[root]);
        }
        result_.stack_bytes = deepest;
        for (std::size_t context = 1; context < contexts_.size(); ++context) {
            for (const std::size_t handler : contexts_[context].roots) {
                result_.stack_bytes += kReturnAddress + stack_[handler];
            }
        }
    }

    void add_notes() {
        std::map<std::string, std::size_t> functions;
        for (std::size_t i = 0; i < module_.functions.size(); ++i) {
            functions[name(i)] = i;
            for (const Context& context : contexts_) functions[name(i) + context.suffix] = i;
        }
        for (assembly::Section& section : result_.module.sections) {
            const auto function = functions.find(section.function);
            if (section.kind != assembly::SectionKind::code || function == functions.end())
                continue;
            if (unbounded_[function->second]) continue;
            section.items.insert(section.items.begin() + 1,
                                 assembly::note(fmt::format("stack {}", stack_[function->second])));
        }
    }

    void finish() {
        total_stack();
        for (std::size_t i = 0; i < module_.functions.size(); ++i) {
            const Function& function = module_.functions[i];
            if (function.interrupt < 0) continue;
            result_.vectors[static_cast<uint16_t>(function.interrupt)] = name(i);
        }
        std::ranges::stable_sort(result_.functions, {}, &FunctionReport::name);
    }

    const Generator& generator_;
    const CompileOptions& options_;
    std::span<const assembly::Module> runtime_;
    Module module_;
    const CallGraph graph_;
    const SafeNames names_;
    RoutineStack routine_stack_;

    std::vector<Context> contexts_;
    std::vector<std::size_t> owner_;
    std::vector<FunctionCode> code_;
    std::vector<bool> done_;
    std::vector<ContextCopies> copies_;
    std::vector<uint32_t> stack_;
    std::vector<bool> unbounded_;  ///< the stack, by function: it or a callee is recursive
    Compiled result_;
};

}  // namespace

Compiled compile_with(const Generator& generator, Module module,
                      std::span<const assembly::Module> runtime, const CompileOptions& options) {
    return Compiler(generator, std::move(module), runtime, options).run();
}

}  // namespace toolchain::codegen
