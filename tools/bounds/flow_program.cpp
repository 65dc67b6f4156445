// flow_program.cpp - see flow_program.hpp.
#include "tools/bounds/flow_program.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>

#include "firmware/config/eeprom_layout.hpp"
#include "tools/budget/budget_error.hpp"

namespace rover_bounds {
namespace {

using rover_budget::BudgetError;

constexpr std::array<std::pair<const char*, uint16_t>, 4> kVectors = {
    {{"TRAP", 0x24}, {"RST 7.5", 0x3C}, {"RST 6.5", 0x34}, {"RST 5.5", 0x2C}}};
constexpr const char* kStartUp = "__reset";  // of the application: the loader is no part of it
constexpr const char* kWaitFunction = "*::rover_wait(*";

/// The last number of a note "KEY ...", or nothing.
std::optional<uint32_t> last_number(std::string_view text, std::string_view key) {
    if (!text.starts_with(key) || text.size() <= key.size() || text[key.size()] != ' ') return {};
    const std::string_view last = text.substr(text.rfind(' ') + 1);
    uint32_t value = 0;
    const auto [at, error] = std::from_chars(last.data(), last.data() + last.size(), value);
    if (error != std::errc() || at != last.data() + last.size()) return {};
    return value;
}

}  // namespace

FlowProgram::FlowProgram(const host_sim::Image& image, const host_sim::Symbols& symbols,
                         const rover_budget::ImageMap& map, FlowTable table)
    : source_{&image, &symbols, {}}, table_(std::move(table)) {
    take_notes(map);
    const host_sim::Symbol* start = symbols.find(kStartUp);
    std::vector<uint16_t> roots = {start == nullptr ? uint16_t{0} : start->address};
    if (roots[0] >= rover::loader::kApplicationFirst) first_ = rover::loader::kApplicationFirst;
    for (const auto& [name, vector] : kVectors) {
        const host_sim::Symbol* function = symbols.function_at(vector);
        if (function == nullptr || function->address != vector) continue;
        handlers_.push_back({name, vector});
        roots.push_back(vector);
    }
    graph_ = read_code(source_, roots);
    rule_used_.resize(table_.loops.size());
    std::vector<std::string> unbounded;
    for (const auto& [entry, procedure] : graph_.procedures) bound_loops(procedure, unbounded);
    if (!unbounded.empty()) {
        std::string places = unbounded[0];
        for (std::size_t i = 1; i < unbounded.size(); ++i) places += "\n  " + unbounded[i];
        throw BudgetError(places, 0, "the loop has no bound",
                          "write it with a constant count, or add `turns` to " + table_.file);
    }
    find_step();
    check_table();
}

void FlowProgram::take_notes(const rover_budget::ImageMap& map) {
    for (const rover_budget::MapNote& note : map.notes) {
        const auto address = static_cast<uint16_t>(note.address);
        if (const auto t = last_number(note.text, "t")) source_.stated_t[address] = *t;
        const auto turns = last_number(note.text, "loop");
        if (!turns) continue;
        if (noted_.emplace(address, *turns).second) continue;
        throw BudgetError(source_place(*source_.symbols, address), 0,
                          "two loops begin at one instruction", "write them as one");
    }
}

void FlowProgram::bound_loops(const Procedure& procedure, std::vector<std::string>& unbounded) {
    std::vector<BoundedLoop>& loops = loops_[procedure.entry];
    if (procedure.stated_t) return;
    unsigned number = 0;
    for (Loop& loop : find_loops(procedure, *source_.symbols)) {
        BoundedLoop bounded{std::move(loop), ++number, LoopKind::turns, 0};
        const auto noted = noted_.find(bounded.loop.address);
        if (noted != noted_.end()) bounded.most = noted->second;
        loops.push_back(std::move(bounded));
    }
    apply_rules(procedure, loops);
    for (const BoundedLoop& loop : loops) {
        if (loop.most != 0) continue;
        unbounded.push_back(fmt::format("{}: {}, loop {} at {:04X}H",
                                        source_place(*source_.symbols, loop.loop.address),
                                        procedure.name, loop.number, loop.loop.address));
    }
}

void FlowProgram::apply_rules(const Procedure& procedure, std::vector<BoundedLoop>& loops) {
    constexpr uint32_t kTurnsOfWait = 2;  // the one that sleeps, and the one that finds it is time
    for (std::size_t i = 0; i < table_.loops.size(); ++i) {
        const LoopRule& rule = table_.loops[i];
        if (!rule.item.fits(procedure.name)) continue;
        for (BoundedLoop& loop : loops) {
            if (loop.number != rule.item.loop) continue;
            rule_used_[i] = true;
            loop.kind = rule.kind;
            const uint32_t turns = rule.kind == LoopKind::turns   ? rule.turns
                                   : rule.kind == LoopKind::waits ? kTurnsOfWait
                                                                  : 1;
            const bool tighter = loop.most == 0 || turns < loop.most;
            if (tighter) loop.most = turns;
        }
    }
}

/// main's endless loop in which rover_wait is called.
void FlowProgram::find_step() {
    const host_sim::Symbol* main = source_.symbols->find("main");
    for (const auto& [entry, procedure] : graph_.procedures) {
        if (FlowItem{kWaitFunction, {}}.fits(procedure.name)) wait_ = entry;
    }
    if (main == nullptr || wait_ == 0 || !graph_.procedures.contains(main->address)) {
        throw BudgetError(table_.file, 0, "the image has no main that calls rover_wait",
                          "give an image of this rover");
    }
    main_ = main->address;
    const Procedure& procedure = graph_.at(main_);
    for (const BoundedLoop& loop : loops_.at(main_)) {
        const auto waits = [&](const Edge& edge) {
            return edge.callee == wait_ && std::ranges::binary_search(loop.loop.blocks, edge.from);
        };
        if (std::ranges::any_of(procedure.edges, waits)) {
            step_ = read_turn(source_, graph_, loop.loop.address);
            break;
        }
    }
    step_.name = "step";
    for (Loop& loop : find_loops(step_, *source_.symbols)) {
        const auto same = std::ranges::find_if(loops_.at(main_), [&](const BoundedLoop& known) {
            return known.loop.address == loop.address;
        });
        BoundedLoop bounded = *same;
        bounded.loop = std::move(loop);
        step_loops_.push_back(std::move(bounded));
    }
}

/// What fits nothing is a leftover of code that has changed.
void FlowProgram::check_table() const {
    const auto refuse = [this](std::size_t line, const std::string& what) {
        throw BudgetError(table_.file, line, what + " fits nothing in the image",
                          "correct the pattern or the loop's number");
    };
    for (std::size_t i = 0; i < table_.loops.size(); ++i) {
        if (!rule_used_[i]) refuse(table_.loops[i].line, table_.loops[i].item.pattern);
    }
    for (const FlowFact& fact : table_.facts) {
        for (const FlowTerm& term : fact.terms) {
            const bool found = std::ranges::any_of(graph_.procedures, [&](const auto& one) {
                const auto& [entry, procedure] = one;
                return term.item.fits(procedure.name) &&
                       (!term.item.loop || *term.item.loop <= loops_.at(entry).size());
            });
            if (!found) refuse(fact.line, term.item.pattern);
        }
    }
}

}  // namespace rover_bounds
