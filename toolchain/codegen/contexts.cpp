// contexts.cpp - see contexts.hpp.
#include "toolchain/codegen/contexts.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace toolchain::codegen {

namespace {

constexpr int32_t kTrap = 0x24;
constexpr int32_t kLastVector = 0x3C;
constexpr int32_t kRestartStep = 8;

void reach(Context& context, const CallGraph& graph, std::size_t root) {
    std::vector<std::size_t> open = {root};
    while (!open.empty()) {
        const std::size_t function = open.back();
        open.pop_back();
        if (context.reached[function]) continue;
        context.reached[function] = true;
        for (const GraphEdge& edge : graph.callees(function)) {
            if (edge.through_pointer) context.by_pointer[edge.callee] = true;
            open.push_back(edge.callee);
        }
    }
}

Context context_of(const CallGraph& graph, std::size_t functions, std::vector<std::size_t> roots) {
    Context context;
    context.reached.assign(functions, false);
    context.by_pointer.assign(functions, false);
    for (const std::size_t root : roots) reach(context, graph, root);
    context.roots = std::move(roots);
    return context;
}

}  // namespace

// RST 0 is the reset; TRAP and RST 5.5, 6.5, 7.5 lie half-way between the restarts.
std::string vector_title(int32_t vector) {
    if (vector <= 0 || vector > kLastVector) return {};
    if (vector == kTrap) return "TRAP";
    if (vector % kRestartStep == 0) return fmt::format("RST {}", vector / kRestartStep);
    const bool half = vector > kTrap && vector % kRestartStep == kRestartStep / 2;
    return half ? fmt::format("RST {}.5", vector / kRestartStep) : std::string();
}

std::string vector_suffix(int32_t vector) {
    std::string suffix = "@";
    for (const char letter : vector_title(vector)) {
        if (letter == ' ' || letter == '.') continue;
        const bool capital = letter >= 'A' && letter <= 'Z';
        suffix += capital ? static_cast<char>(letter - 'A' + 'a') : letter;
    }
    return suffix;
}

std::vector<Context> find_contexts(const Module& module, const CallGraph& graph,
                                   std::vector<std::size_t> main_roots) {
    const std::size_t count = module.functions.size();
    std::vector<std::size_t> handlers;
    for (std::size_t i = 0; i < count; ++i) {
        if (module.functions[i].interrupt >= 0) handlers.push_back(i);
    }
    std::ranges::sort(handlers, {}, [&](std::size_t i) { return module.functions[i].interrupt; });
    std::vector<Context> contexts = {context_of(graph, count, std::move(main_roots))};
    contexts[0].title = "the main program";
    for (const std::size_t handler : handlers) {
        Context context = context_of(graph, count, {handler});
        const Function& function = module.functions[handler];
        context.suffix = vector_suffix(function.interrupt);
        context.title = fmt::format("the interrupt function '{}'", module.symbols[function.symbol]);
        contexts.push_back(std::move(context));
    }
    const std::vector<std::size_t> owner = owners(contexts, count);
    for (std::size_t i = 0; i < count; ++i) {
        if (owner[i] != kNoContext || !module.functions[i].address_taken) continue;
        contexts[0].roots.push_back(i);
        reach(contexts[0], graph, i);
    }
    return contexts;
}

std::vector<std::size_t> owners(const std::vector<Context>& contexts, std::size_t functions) {
    std::vector<std::size_t> owner(functions, kNoContext);
    for (std::size_t context = contexts.size(); context-- > 0;) {
        for (std::size_t i = 0; i < functions; ++i) {
            if (contexts[context].reached[i]) owner[i] = context;
        }
    }
    return owner;
}

}  // namespace toolchain::codegen
