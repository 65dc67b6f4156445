// checks.cpp - see checks.hpp.
#include "toolchain/codegen/checks.hpp"

#include <fmt/format.h>

#include <map>
#include <set>

#include "toolchain/codegen/contexts.hpp"
#include "toolchain/codegen/names.hpp"

namespace toolchain::codegen {

namespace {

std::string readable(const Module& module, std::size_t function) {
    const std::string& name = module.symbols[module.functions[function].symbol];
    const std::string title = demangled(name);
    return title.empty() ? name : title;
}

/// "file:line: text", or the text alone.
std::string at(const Module& module, SourcePlace place, const std::string& text) {
    const std::string where = place_text(module, place);
    return where.empty() ? text : fmt::format("{}: {}", where, text);
}

/// Where the first operation of a function comes from.
SourcePlace first_place(const Function& function) {
    for (const Block& block : function.blocks) {
        for (const Operation& operation : block.operations) {
            if (operation.place.file != kNone) return operation.place;
        }
        if (block.terminator.place.file != kNone) return block.terminator.place;
    }
    return {};
}

std::string recursion_text(const Module& module, const CallGraph& graph, std::size_t function) {
    const std::vector<GraphEdge> cycle = graph.cycle(function);
    std::string way = readable(module, function);
    for (const GraphEdge& edge : cycle) {
        way += fmt::format(" -> {}", readable(module, edge.callee));
        const std::string where = place_text(module, edge.place);
        const char* pointer = edge.through_pointer ? "through a pointer" : "";
        if (!where.empty() || edge.through_pointer) {
            way += fmt::format(" ({}{}{})", where,
                               where.empty() || !edge.through_pointer ? "" : ", ", pointer);
        }
    }
    return at(module, cycle.empty() ? SourcePlace{} : cycle.front().place,
              fmt::format("recursion: {}: static frames hold one call at a time: make it a loop, "
                          "or use --allow-recursion",
                          way));
}

void check_recursion(const Module& module, const CallGraph& graph, std::vector<std::string>& out) {
    std::set<std::size_t> groups;
    for (std::size_t i = 0; i < module.functions.size(); ++i) {
        if (!graph.is_recursive(i) || !groups.insert(graph.group(i)).second) continue;
        out.push_back(recursion_text(module, graph, i));
    }
}

void check_handler(const Module& module, std::size_t index, std::vector<std::string>& out) {
    const Function& function = module.functions[index];
    const std::string name = readable(module, index);
    const SourcePlace place = first_place(function);
    if (vector_title(function.interrupt).empty()) {
        out.push_back(at(module, place,
                         fmt::format("interrupt function '{}': no interrupt enters at {:02X}H: "
                                     "take a vector of i85.h",
                                     name, function.interrupt)));
    }
    if (!function.parameters.empty() || function.result_size != 0) {
        out.push_back(at(module, place,
                         fmt::format("interrupt function '{}' has parameters or a result: nobody "
                                     "passes or takes them",
                                     name)));
    }
}

void check_interrupts(const Module& module, const CallGraph& graph, std::vector<std::string>& out) {
    std::map<int32_t, std::size_t> vectors;
    for (std::size_t i = 0; i < module.functions.size(); ++i) {
        const Function& function = module.functions[i];
        for (const GraphEdge& edge : graph.callees(i)) {
            if (module.functions[edge.callee].interrupt < 0) continue;
            out.push_back(at(module, edge.place,
                             fmt::format("interrupt function '{}' is called{}: only the processor "
                                         "enters it: move its work into a function of its own",
                                         readable(module, edge.callee),
                                         edge.through_pointer ? " through a pointer" : "")));
        }
        if (function.interrupt < 0) continue;
        check_handler(module, i, out);
        const auto [other, is_new] = vectors.try_emplace(function.interrupt, i);
        if (is_new) continue;
        out.push_back(at(
            module, first_place(function),
            fmt::format("interrupt functions '{}' and '{}' have the same vector {:02X}H",
                        readable(module, other->second), readable(module, i), function.interrupt)));
    }
}

}  // namespace

std::string place_text(const Module& module, SourcePlace place) {
    if (place.file == kNone) return {};
    return fmt::format("{}:{}", module.files.at(place.file), place.line);
}

std::vector<std::string> call_refusals(const Module& module, const CallGraph& graph,
                                       bool allow_recursion) {
    std::vector<std::string> refusals;
    if (!allow_recursion) check_recursion(module, graph, refusals);
    check_interrupts(module, graph, refusals);
    return refusals;
}

}  // namespace toolchain::codegen
