// profiled_target.hpp - the image on the simulated board as a target of drives, with what every
// step cost: the report's section about the machine. Depends on   host_sim/bind/board_target.hpp,
// step_profile.hpp, tools/report/machine.hpp.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "host_sim/bind/board_target.hpp"
#include "tools/budget/image_map.hpp"
#include "tools/budget/placement.hpp"
#include "tools/budget/step_profile.hpp"
#include "tools/report/machine.hpp"

namespace rover_budget {

class ProfiledTarget final : public host_sim::ControllerTarget {
public:
    /// @param hex  the image; its .map and .sym stand beside it
    /// @errors  ImageError, BudgetError
    explicit ProfiledTarget(const std::filesystem::path& hex,
                            host_sim::SlowStep slow_step = host_sim::SlowStep::fail);

    void begin(const hal::Calibration& calibration) override;
    [[nodiscard]] std::string identity() const override { return target_.identity(); }
    void step(std::vector<host_sim::LogStep>& steps, std::size_t index) override;
    void finish(std::vector<host_sim::LogStep>& steps) override;

    /// What the steps since begin() cost.
    [[nodiscard]] report::Machine machine() const;

private:
    ProfiledTarget(const std::filesystem::path& hex, host_sim::Image image,
                   host_sim::SlowStep slow_step);
    [[nodiscard]] StepProfile::Program program() const;

    std::string image_text_;
    host_sim::Symbols symbols_;
    ImageMap map_;
    ModuleTable table_;
    Placement placement_;
    host_sim::BoardTarget target_;
    StepProfile profile_;
    std::vector<std::uint32_t> main_line_t_, interrupts_t_;
    bool flying_ = false;
};

}  // namespace rover_budget
