// tablegen - prints and writes the firmware's constant tables, and measures what they achieve.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

#include "tools/tablegen/accuracy.hpp"
#include "tools/tablegen/table.hpp"

namespace {

constexpr int kExitUsage = 2;
constexpr int kExitBadInput = 3;

void write_tables(const std::filesystem::path& root) {
    for (const tablegen::Table& table : tablegen::firmware_tables()) {
        const std::filesystem::path folder = root / table.folder;
        if (!std::filesystem::is_directory(folder)) {
            throw std::runtime_error(fmt::format(
                "{}: no such folder; run in the project's root or give --root", folder.string()));
        }
        const std::filesystem::path path = folder / table.file;
        std::ofstream out(path, std::ios::binary);
        out << tablegen::render(table);
        out.close();
        if (!out) {
            throw std::runtime_error(
                fmt::format("{}: cannot write; is the folder writable?", path.string()));
        }
        fmt::print("{}: {} entries\n", path.string(), table.values.size());
    }
}

int run(int argc, char** argv) {
    CLI::App app{
        "Tables of the firmware, computed in double precision.\n\n"
        "  tablegen write                             rewrite every table, run in the root\n"
        "  tablegen accuracy                          measure sine, atan2, isqrt\n"
        "  tablegen square --scale 0.16 --entries 256 print a table of squares\n"};
    app.require_subcommand(1);

    std::string root = ".";
    CLI::App* write = app.add_subcommand("write", "Write every table of the firmware as a header");
    write->add_option("--root", root, "Root of the project")->capture_default_str();

    CLI::App* accuracy =
        app.add_subcommand("accuracy", "Print the errors of the core functions as a table");

    std::string name = "kSquare";
    int entries = 256;
    double scale = 1.0;
    CLI::App* square = app.add_subcommand(
        "square", "Print a saturating table of squares, min(65535, round(scale * i * i))");
    square->add_option("--name", name, "Name of the constant")->capture_default_str();
    square->add_option("--entries", entries, "Number of entries")->capture_default_str();
    square->add_option("--scale", scale, "Value of entry 1")->capture_default_str();

    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : kExitUsage;
    }
    if (*write) write_tables(root);
    if (*accuracy) fmt::print("{}", tablegen::accuracy_table(tablegen::measure_accuracy()));
    if (*square) {
        fmt::print("{}", tablegen::render(tablegen::square_table(name, entries, scale)));
    }
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    try {
        return run(argc, argv);
    } catch (const std::invalid_argument& error) {
        fmt::print(stderr, "tablegen: {}\n", error.what());
        return kExitUsage;
    } catch (const std::exception& error) {
        fmt::print(stderr, "tablegen: {}\n", error.what());
        return kExitBadInput;
    }
}
