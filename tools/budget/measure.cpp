// measure.cpp - see measure.hpp.
#include "tools/budget/measure.hpp"

#include <algorithm>

#include "firmware/config/eeprom_layout.hpp"
#include "hal/board/rb85.hpp"
#include "host_sim/image/identity.hpp"
#include "host_sim/log/log_io.hpp"
#include "tools/budget/budget_error.hpp"

namespace rover_budget {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kProgressEverySteps = 16;

fs::path beside(fs::path image, const char* ending) {
    return image.replace_extension(ending);
}

uint16_t address_of(const host_sim::Symbols& symbols, const char* name, const fs::path& image) {
    const host_sim::Symbol* symbol = symbols.find(name);
    if (symbol != nullptr) return symbol->address;
    throw host_sim::ImageError(image.string(), 0, std::string("its symbols have no ") + name,
                               "give an image of this rover with its .sym file beside it");
}

std::string name_of(const fs::path& log) {
    return log.stem().string();
}

/// One log from power-up to its last frame.
LogSize fly(host_sim::BoardTarget& target, StepProfile& profile, const fs::path& path,
            const std::function<void(double)>& progress) {
    host_sim::Log log = host_sim::load_log(path);
    profile.begin(name_of(path));
    target.begin(log.head.calibration);
    profile.count_steps();
    for (std::size_t i = 0; i < log.steps.size(); ++i) {
        target.step(log.steps, i);
        if (progress && i % kProgressEverySteps == 0) {
            progress(static_cast<double>(i) / static_cast<double>(log.steps.size()));
        }
    }
    return {name_of(path), log.steps.size()};
}

}  // namespace

std::vector<fs::path> logs_below(const fs::path& folder) {
    std::vector<fs::path> logs;
    std::error_code problem;
    for (const auto& entry : fs::recursive_directory_iterator(folder, problem)) {
        if (entry.path().extension() == ".rlog") logs.push_back(entry.path());
    }
    std::ranges::sort(logs);
    return logs;
}

Figures measure(const MeasureOptions& options, const std::function<void(double)>& progress) {
    const auto text = [&](const char* name) {
        return host_sim::read_image_file(options.folder / name);
    };
    const std::string modules_name = (options.folder / "modules.csv").string();
    const ModuleTable table = ModuleTable::parse(text("modules.csv"), modules_name);
    const host_sim::Image image = host_sim::load_hex(options.image);
    const host_sim::Symbols symbols = host_sim::load_symbols(beside(options.image, ".sym"));
    const fs::path map_path = beside(options.image, ".map");
    const ImageMap map = parse_map(host_sim::read_image_file(map_path), map_path.string());

    Figures figures;
    figures.identity = host_sim::describe(host_sim::read_identity(image));
    figures.rom_bytes = map.rom_used;
    figures.ram_bytes = map.ram_used;
    figures.frame_bytes = map.region("frames").size;
    figures.stack_bytes = map.region("stack").size;
    figures.modules = table.modules();
    figures.placement = place(map, symbols, table);
    figures.operations =
        parse_operations(text("operations.csv"), (options.folder / "operations.csv").string());

    StepProfile profile({&symbols, &figures.modules, &figures.placement.module_of,
                         address_of(symbols, "rover_step_count", options.image),
                         map.region("stack").first + map.region("stack").size,
                         rover::loader::kApplicationFirst});
    host_sim::BoardTarget target(image, symbols, options.slow_step);
    target.observe([&profile](const host_sim::StepRecord& step, const host_sim::CpuState& after) {
        profile.observe(step, after);
    });
    for (std::size_t i = 0; i < options.logs.size(); ++i) {
        figures.logs.push_back(fly(target, profile, options.logs[i], [&](double share) {
            if (progress) {
                progress((static_cast<double>(i) + share) /
                         static_cast<double>(options.logs.size()));
            }
        }));
    }
    figures.profile = profile.figures();
    return figures;
}

}  // namespace rover_budget
