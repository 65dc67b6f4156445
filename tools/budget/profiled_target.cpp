// profiled_target.cpp - see profiled_target.hpp.
#include "tools/budget/profiled_target.hpp"

#include <algorithm>

#include "firmware/config/eeprom_layout.hpp"
#include "hal/board/rb85.hpp"
#include "host_sim/image/identity.hpp"
#include "tools/budget/budget_error.hpp"
#include "tools/budget/figures.hpp"

namespace rover_budget {
namespace {

namespace fs = std::filesystem;

// The split into main line, interrupts, waiting and boot: what waiting and boot call is theirs.
constexpr const char* kParts =
    "boot,boot,__reset\n"
    "boot,boot,*::rover_boot*\n"
    "wait,idle,*::rover_wait*\n"
    "main,step,main\n"
    "rest,library,*\n";

// What there is room for, beside the parts of the board: the firmware's share of the RAM, and of
// the time for interrupts.
constexpr double kRamShareBytes = 2048;
constexpr double kInterruptSharePercent = 15;
constexpr double kStepT = 10.0 * hal::rb85::kTickCount;
constexpr double kRomBytes = hal::rb85::kEepromLast + 1.0;

fs::path beside(fs::path image, const char* ending) {
    return image.replace_extension(ending);
}

}  // namespace

ProfiledTarget::ProfiledTarget(const fs::path& hex, host_sim::SlowStep slow_step)
    : ProfiledTarget(hex, host_sim::load_hex(hex), slow_step) {}

ProfiledTarget::ProfiledTarget(const fs::path& hex, host_sim::Image image,
                               host_sim::SlowStep slow_step)
    : image_text_(host_sim::describe(host_sim::read_identity(image))),
      symbols_(host_sim::load_symbols(beside(hex, ".sym"))),
      map_(parse_map(host_sim::read_image_file(beside(hex, ".map")), beside(hex, ".map").string())),
      table_(ModuleTable::parse(kParts, "parts")),
      placement_(place(map_, symbols_, table_)),
      target_(image, symbols_, slow_step),
      profile_(program()) {
    profile_.step_ended = [this](uint64_t main_t, uint64_t interrupt_t) {
        main_line_t_.push_back(static_cast<std::uint32_t>(main_t));
        interrupts_t_.push_back(static_cast<std::uint32_t>(interrupt_t));
    };
    target_.observe([this](const host_sim::StepRecord& step, const host_sim::CpuState& after) {
        if (flying_) profile_.observe(step, after);
    });
}

StepProfile::Program ProfiledTarget::program() const {
    const host_sim::Symbol* count = symbols_.find("rover_step_count");
    if (count == nullptr) {
        throw BudgetError("symbols", 0, "have no rover_step_count",
                          "give an image of this rover with its .sym file beside it");
    }
    const MapRegion& stack = map_.region("stack");
    return {&symbols_,      &table_.modules(),        &placement_.module_of,
            count->address, stack.first + stack.size, rover::loader::kApplicationFirst};
}

void ProfiledTarget::begin(const hal::Calibration& calibration) {
    main_line_t_.clear();
    interrupts_t_.clear();
    flying_ = true;
    profile_.begin("");
    target_.begin(calibration);
    profile_.count_steps();
}

void ProfiledTarget::step(std::vector<host_sim::LogStep>& steps, std::size_t index) {
    target_.step(steps, index);
    // Before a restart the board may run steps that are nobody's: the last one is the log's.
    for (auto* series : {&main_line_t_, &interrupts_t_}) {
        const std::uint32_t last = series->empty() ? 0 : series->back();
        series->resize(index + 1);
        series->back() = last;
    }
}

void ProfiledTarget::finish(std::vector<host_sim::LogStep>& steps) {
    flying_ = false;  // steps that only wait for the last frames are not the log's
    target_.finish(steps);
}

report::Machine ProfiledTarget::machine() const {
    const ProfileFigures& figures = profile_.figures();
    report::Machine machine;
    machine.image = image_text_;
    machine.main_line_t = main_line_t_;
    machine.interrupts_t = interrupts_t_;
    const auto worst = main_line_t_.empty() ? 0U : std::ranges::max(main_line_t_);
    machine.bars = {
        {"Longest step, main line", static_cast<double>(worst), kStepT, "T-states"},
        {"Time in interrupts", static_cast<double>(interrupt_share_e4(figures)) / 100.0,
         kInterruptSharePercent, "%"},
        {"ROM", static_cast<double>(map_.rom_used), kRomBytes, "bytes"},
        {"RAM with stack", static_cast<double>(map_.ram_used), kRamShareBytes, "bytes"}};
    return machine;
}

}  // namespace rover_budget
