// copies.cpp - see copies.hpp.
#include "toolchain/codegen/copies.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "toolchain/asm/clone.hpp"
#include "toolchain/asm/reach.hpp"
#include "toolchain/codegen/abi.hpp"
#include "toolchain/codegen/emit.hpp"
#include "toolchain/isa/instruction_set.hpp"

namespace toolchain::codegen {

namespace {

using assembly::Item;
using assembly::Renaming;
using assembly::Section;
using assembly::SectionKind;
using Names = std::set<std::string>;

bool transfers_control(const Item& item) {
    if (item.kind != assembly::ItemKind::instruction) return false;
    const isa::Flow flow = isa::instruction(item.opcode).flow;
    return flow == isa::Flow::call || flow == isa::Flow::jump;
}

class Copier {
public:
    Copier(const CopyInput& input, assembly::Module& program, std::vector<std::string>& refusals)
        : in_(input),
          program_(program),
          refusals_(refusals),
          originals_(program),
          runtime_(input.runtime),
          owner_(owners(input.contexts, input.module.functions.size())) {}

    std::vector<ContextCopies> run() {
        index_program();
        find_state();
        std::vector<ContextCopies> result(in_.contexts.size());
        for (std::size_t context = 0; context < in_.contexts.size(); ++context) {
            if (context != 0) result[context].functions = copied_functions(context);
            if (context != 0) copy(context, result[context].functions);
            use_cells(context);
        }
        return result;
    }

private:
    [[nodiscard]] const std::string& name(std::size_t function) const {
        return in_.names.of(in_.module.functions[function].symbol);
    }

    // -- What has memory of its own --------------------------------------------------------------

    void index_program() {
        for (std::size_t i = 0; i < in_.module.functions.size(); ++i) functions_[name(i)] = i;
        references_.resize(in_.module.functions.size());
        for (const Section& section : program_.sections) {
            if (section.kind == SectionKind::frame) note_frame(section);
            if (section.kind == SectionKind::persistent) shared_memory_.insert(section.name);
            if (section.kind != SectionKind::code) continue;
            Names& names = references_[functions_.at(section.name)];
            for (const Item& item : section.items) {
                const std::string_view reference = assembly::reference_of(item);
                if (!reference.empty() && !assembly::is_local(reference)) names.emplace(reference);
            }
        }
    }

    // A caller's variable is memory of the callee that knows its place, too.
    void note_frame(const Section& section) {
        has_frame_.insert(section.function);
        for (const Item& item : section.items) {
            if (item.kind == assembly::ItemKind::label) shared_memory_.insert(item.operand.symbol);
        }
    }

    /// The sections of RAM that a name of the runtime leads to.
    const std::vector<std::size_t>& cells_of(const std::string& name) {
        const auto [entry, is_new] = cells_.try_emplace(name);
        if (!is_new || !runtime_.section_of(name)) return entry->second;
        const auto reached = runtime_.reachable({&name, 1}, [](const Section&) { return false; });
        for (std::size_t i = 0; i < reached.size(); ++i) {
            if (reached[i] && !assembly::in_rom(runtime_.sections()[i]->kind)) {
                entry->second.push_back(i);
            }
        }
        return entry->second;
    }

    // A function without memory that calls one with memory is copied with it.
    void find_state() {
        const std::size_t count = in_.module.functions.size();
        state_.assign(count, false);
        for (std::size_t i = 0; i < count; ++i) {
            state_[i] =
                has_frame_.contains(name(i)) ||
                std::ranges::any_of(references_[i], [&](const std::string& reference) {
                    return shared_memory_.contains(reference) || !cells_of(reference).empty();
                });
        }
        for (bool changed = true; changed;) {
            changed = false;
            for (const std::size_t i : in_.graph.bottom_up()) {
                if (state_[i]) continue;
                const auto& callees = in_.graph.callees(i);
                state_[i] = std::ranges::any_of(
                    callees, [&](const GraphEdge& edge) { return state_[edge.callee]; });
                changed = changed || state_[i];
            }
        }
    }

    // -- Copies ----------------------------------------------------------------------------------

    std::set<std::size_t> copied_functions(std::size_t context) {
        std::set<std::size_t> copied;
        const Context& here = in_.contexts[context];
        for (std::size_t i = 0; i < owner_.size(); ++i) {
            if (!here.reached[i] || owner_[i] == context || !state_[i]) continue;
            copied.insert(i);
            if (here.by_pointer[i]) refuse(i, here, in_.contexts[owner_[i]]);
        }
        return copied;
    }

    void refuse(std::size_t function, const Context& here, const Context& other) {
        std::string where;
        for (const Section& section : program_.sections) {
            if (section.name != name(function) || !section.location.known()) continue;
            where = fmt::format("{}:{}: ", program_.files.at(section.location.file),
                                section.location.line);
        }
        refusals_.push_back(fmt::format(
            "{}'{}' may be called through a pointer by {}, and by {} too: it has static memory, "
            "which holds one call at a time: call it by name from one of them, or give its kind of "
            "pointer other parameters",
            where, in_.module.symbols[in_.module.functions[function].symbol], here.title,
            other.title));
    }

    /// Functions whose code belongs to a context alone: first reached by it.
    [[nodiscard]] bool is_own(std::size_t function, std::size_t context) const {
        return owner_[function] == context;
    }

    // Names of the runtime that the context needs copies of: they lead to cells already in use.
    Names runtime_roots(std::size_t context) {
        Names roots;
        for (std::size_t i = 0; i < owner_.size(); ++i) {
            if (!in_.contexts[context].reached[i]) continue;
            for (const std::string& reference : references_[i]) {
                const auto& cells = cells_of(reference);
                if (std::ranges::any_of(cells, [&](std::size_t cell) { return used_[cell]; })) {
                    roots.insert(reference);
                }
            }
        }
        return roots;
    }

    void use_cells(std::size_t context) {
        used_.resize(runtime_.sections().size());
        for (std::size_t i = 0; i < owner_.size(); ++i) {
            if (!in_.contexts[context].reached[i]) continue;
            for (const std::string& reference : references_[i]) {
                for (const std::size_t cell : cells_of(reference)) used_[cell] = true;
            }
        }
    }

    /// All sections but those that hold the memory of copied functions, and the way there.
    Names kept_sections(const std::set<std::size_t>& copied) {
        Names kept;
        for (const Section& section : originals_.sections) {
            const auto function = functions_.find(section.function);
            const bool is_copied =
                function != functions_.end() && copied.contains(function->second);
            if (!is_copied && section.kind != SectionKind::persistent) kept.insert(section.name);
        }
        for (const Section* section : runtime_.sections()) {
            const bool has_cells = !assembly::in_rom(section->kind) ||
                                   std::ranges::any_of(section->items, [&](const Item& item) {
                                       return item.kind == assembly::ItemKind::label &&
                                              !cells_of(item.operand.symbol).empty();
                                   });
            if (!has_cells) kept.insert(section->name);
        }
        return kept;
    }

    void copy(std::size_t context, const std::set<std::size_t>& copied) {
        Names names = runtime_roots(context);
        for (const std::size_t function : copied) names.insert(name(function));
        if (names.empty()) return;
        const std::string& suffix = in_.contexts[context].suffix;
        std::vector<assembly::Module> all(in_.runtime.begin(), in_.runtime.end());
        all.push_back(originals_);
        const std::vector<std::string> roots(names.begin(), names.end());
        assembly::Clones clones =
            assembly::clone_sections(all, roots, suffix, kept_sections(copied));
        for (std::size_t i = 0; i < originals_.sections.size(); ++i) {
            Section& section = program_.sections[i];
            if (section.kind != SectionKind::code) continue;
            if (is_own(functions_.at(section.name), context)) use(section, clones.renaming);
        }
        add(std::move(clones.module), suffix);
    }

    // A call goes to the copy. A function's address does not: the pointer may be called by anyone,
    // and the main program or whoever owns the function calls the original.
    void use(Section& section, const Renaming& renaming) const {
        Renaming calls_only;
        Renaming others;
        for (const auto& [from, to] : renaming) {
            (functions_.contains(from) ? calls_only : others).emplace(from, to);
        }
        assembly::rename_references(section, others);
        for (Item& item : section.items) {
            if (!transfers_control(item)) continue;
            const auto found = calls_only.find(item.operand.symbol);
            if (found != calls_only.end()) item.operand.symbol = found->second;
        }
    }

    void add(assembly::Module&& clones, const std::string& suffix) {
        const auto first_file = static_cast<uint32_t>(program_.files.size());
        program_.files.insert(program_.files.end(), clones.files.begin(), clones.files.end());
        for (Section& section : clones.sections) {
            section.location.file += first_file;
            for (Item& item : section.items) {
                item.location.file += first_file;
                restore_address(item, suffix);
            }
            program_.sections.push_back(std::move(section));
        }
    }

    // clone_sections() lets everything refer to copies.
    void restore_address(Item& item, const std::string& suffix) const {
        if (item.kind == assembly::ItemKind::label || transfers_control(item)) return;
        std::string& symbol = item.operand.symbol;
        if (!symbol.ends_with(suffix)) return;
        const std::string original = symbol.substr(0, symbol.size() - suffix.size());
        if (functions_.contains(original)) symbol = original;
    }

    const CopyInput& in_;
    assembly::Module& program_;
    std::vector<std::string>& refusals_;
    const assembly::Module originals_;  ///< before any reference has changed
    const assembly::NameIndex runtime_;
    const std::vector<std::size_t> owner_;

    std::map<std::string, std::size_t> functions_;
    std::set<std::string> has_frame_;      ///< names of functions
    std::set<std::string> shared_memory_;  ///< frames; arguments and results through pointers
    std::vector<Names> references_;        ///< by function
    std::vector<bool> state_;              ///< by function: it or a callee has memory
    std::map<std::string, std::vector<std::size_t>> cells_;
    std::vector<bool> used_;  ///< sections of the runtime that an earlier context uses
};

}  // namespace

std::vector<ContextCopies> make_copies(const CopyInput& input, assembly::Module& program,
                                       std::vector<std::string>& refusals) {
    return Copier(input, program, refusals).run();
}

}  // namespace toolchain::codegen
