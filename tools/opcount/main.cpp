// opcount - counts the elementary operations of the slip-and-sinkage estimator.
#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "tools/opcount/map_grid_count.hpp"

int main(int argc, char** argv) {
    CLI::App app{
        "Elementary operations a cycle of the slip-and-sinkage estimator, by category.\n\n"
        "  opcount           mean and worst cycle, beside the 1994 paper's figure\n"
        "  opcount --budget  the exact numbers, for tests/budgets/operations.csv\n"};
    bool as_budget = false;
    app.add_flag("--budget", as_budget, "Print the budget file");
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : 2;
    }
    const opcount::MapGridCount count = opcount::count_map_grid();
    fmt::print("{}", as_budget ? opcount::budget(count) : opcount::describe(count));
    return 0;
}
