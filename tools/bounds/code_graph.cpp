// code_graph.cpp - see code_graph.hpp.
#include "tools/bounds/code_graph.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "tools/budget/budget_error.hpp"

namespace rover_bounds {
namespace {

using rover_budget::BudgetError;
using toolchain::isa::Flow;

/// Follows one procedure from its entry to its ends.
class ProcedureReader {
public:
    /// @param entries  where other procedures begin
    /// @param turn     a jump to the entry ends the procedure
    ProcedureReader(const CodeSource& source, const std::set<uint16_t>& entries, bool turn)
        : source_(source), entries_(entries), turn_(turn) {}

    Procedure run(uint16_t entry) {
        procedure_.entry = entry;
        const host_sim::Symbol* symbol = source_.symbols->at(entry);
        const bool named = symbol != nullptr && symbol->address == entry;
        procedure_.name = named ? symbol->name : source_.symbols->describe(entry);
        if (procedure_.name.empty()) procedure_.name = fmt::format("{:04X}H", entry);
        find_instructions(entry);
        find_blocks(entry);
        for (std::size_t i = 0; i < procedure_.blocks.size(); ++i) add_edges(i);
        return std::move(procedure_);
    }

private:
    /// Does a jump or a fall from `from` to `to` leave the procedure for another one?
    [[nodiscard]] bool leaves(uint16_t to) const {
        return to == procedure_.entry ? turn_ : entries_.contains(to);
    }

    struct Way {
        std::optional<uint16_t> to, callee;
        uint32_t t = 0;
    };

    [[nodiscard]] Way jump(uint16_t target, uint32_t t) const {
        if (target == procedure_.entry && turn_) return {{}, {}, t};
        if (leaves(target)) return {{}, target, t};
        return {target, {}, t};
    }

    /// Where it goes on behind an instruction.
    [[nodiscard]] std::vector<Way> ways(const Decoded& at) const {
        const auto& entry = *at.entry;
        std::vector<Way> ways;
        if (entry.conditional()) ways.push_back(jump(at.behind(), entry.t_not_taken));
        switch (entry.flow) {
            case Flow::next:
            case Flow::halt:
                return {jump(at.behind(), entry.t_taken)};
            case Flow::jump:
                ways.push_back(jump(at.operand, entry.t_taken));
                return ways;
            case Flow::call:
                ways.push_back({at.behind(), at.operand, entry.t_taken});
                return ways;
            case Flow::ret:
                ways.push_back({{}, {}, entry.t_taken});
                return ways;
            case Flow::restart:
            case Flow::jump_hl:
                break;
        }
        throw BudgetError(source_place(*source_.symbols, at.address), 0,
                          fmt::format("{} at {:04X}H goes to an address that is not known",
                                      entry.mnemonic(), at.address),
                          "use a switch without a table, or a call by name");
    }

    void find_instructions(uint16_t entry) {
        std::vector<uint16_t> open = {entry};
        leaders_.insert(entry);
        while (!open.empty()) {
            const uint16_t address = open.back();
            open.pop_back();
            if (instructions_.contains(address)) continue;
            const Decoded at = decode(source_, address);
            instructions_.emplace(address, at);
            const std::vector<Way> found = ways(at);
            const bool straight = found.size() == 1 && at.entry->flow == Flow::next;
            for (const Way& way : found) {
                if (!way.to) continue;
                open.push_back(*way.to);
                if (!straight) leaders_.insert(*way.to);
            }
        }
    }

    void find_blocks(uint16_t entry) {
        block_at_.emplace(entry, 0);
        procedure_.blocks.push_back({entry, entry});
        for (const uint16_t leader : leaders_) {
            if (leader == entry) continue;
            block_at_.emplace(leader, procedure_.blocks.size());
            procedure_.blocks.push_back({leader, leader});
        }
    }

    void add_edges(std::size_t index) {
        Block& block = procedure_.blocks[index];
        uint32_t t = 0;
        Decoded at = instructions_.at(block.first);
        std::vector<Way> found = ways(at);
        while (found.size() == 1 && found[0].to && !found[0].callee &&
               !leaders_.contains(*found[0].to)) {
            t += found[0].t;
            at = instructions_.at(*found[0].to);
            found = ways(at);
        }
        block.last = at.address;
        for (const Way& way : found) {
            std::optional<std::size_t> to;
            if (way.to) to = block_at_.at(*way.to);
            procedure_.edges.push_back({index, to, t + way.t, way.callee});
        }
    }

    const CodeSource& source_;
    const std::set<uint16_t>& entries_;
    bool turn_;
    Procedure procedure_;
    std::map<uint16_t, Decoded> instructions_;
    std::set<uint16_t> leaders_;
    std::map<uint16_t, std::size_t> block_at_;
};

/// First instructions of all functions that have a name, and of what has stated T-states.
std::set<uint16_t> known_entries(const CodeSource& source) {
    std::set<uint16_t> entries;
    for (const host_sim::Symbol& symbol : source.symbols->all()) {
        if (symbol.is_function()) entries.insert(symbol.address);
    }
    for (const auto& [address, t] : source.stated_t) entries.insert(address);
    return entries;
}

}  // namespace

std::string source_place(const host_sim::Symbols& symbols, uint16_t address) {
    const host_sim::Symbol* line = symbols.source_at(address);
    if (line == nullptr) return fmt::format("address {:04X}H", address);
    return fmt::format("{}:{}", line->source, line->source_line);
}

Decoded decode(const CodeSource& source, uint16_t address) {
    const auto& bytes = source.image->bytes;
    const auto& entry = toolchain::isa::instruction(bytes[address]);
    for (unsigned i = 0; i < entry.bytes; ++i) {
        if (address + i < host_sim::kAddressSpaceSize && source.image->present[address + i])
            continue;
        throw BudgetError(
            source.image->file, 0,
            fmt::format("its program goes on at {:04X}H, where no bytes are", address + i),
            "take the image and the symbols of one build");
    }
    Decoded at{&entry, address, 0};
    if (entry.bytes == 3) {
        at.operand = static_cast<uint16_t>(bytes[address + 1] | bytes[address + 2] << 8);
    }
    return at;
}

CodeGraph read_code(const CodeSource& source, const std::vector<uint16_t>& roots) {
    CodeGraph graph;
    const std::set<uint16_t> entries = known_entries(source);
    std::vector<uint16_t> open = roots;
    while (!open.empty()) {
        const uint16_t entry = open.back();
        open.pop_back();
        if (graph.procedures.contains(entry)) continue;
        Procedure procedure = ProcedureReader(source, entries, false).run(entry);
        const auto stated = source.stated_t.find(entry);
        if (stated != source.stated_t.end()) procedure.stated_t = stated->second;
        for (const Edge& edge : procedure.edges) {
            if (edge.callee) open.push_back(*edge.callee);
        }
        graph.procedures.emplace(entry, std::move(procedure));
    }
    return graph;
}

Procedure read_turn(const CodeSource& source, const CodeGraph& graph, uint16_t header) {
    const std::set<uint16_t> entries = known_entries(source);
    Procedure turn = ProcedureReader(source, entries, true).run(header);
    for (const Edge& edge : turn.edges) {
        if (!edge.callee || graph.procedures.contains(*edge.callee)) continue;
        throw std::logic_error("a turn that calls what its procedure does not");
    }
    return turn;
}

std::set<uint16_t> CodeGraph::reached_from(uint16_t entry) const {
    std::set<uint16_t> reached;
    std::vector<uint16_t> open = {entry};
    while (!open.empty()) {
        const uint16_t one = open.back();
        open.pop_back();
        if (!reached.insert(one).second) continue;
        const Procedure& procedure = at(one);
        if (procedure.stated_t) continue;
        for (const Edge& edge : procedure.edges) {
            if (edge.callee) open.push_back(*edge.callee);
        }
    }
    return reached;
}

}  // namespace rover_bounds
