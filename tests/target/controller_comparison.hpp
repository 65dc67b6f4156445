// controller_comparison.hpp - the controller on the target and on the host, side by side.
// Depends on   firmware, toolchain/driver, tests/toolchain/codegen/interpreter.hpp, machine.hpp.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "firmware/executive/estimates.hpp"
#include "tests/target/compile.hpp"
#include "tests/target/machine.hpp"
#include "tests/target/records.hpp"
#include "tests/toolchain/codegen/interpreter.hpp"

namespace target_test {

/// Of controller_program.cpp with the firmware as it is in the tree.
[[nodiscard]] toolchain::driver::Request firmware_request(const Level& level);

/// What a program with the mailbox can do.
class Mailbox {
public:
    virtual ~Mailbox() = default;
    virtual void reset(const Record& calibration) = 0;
    virtual void step(const Record& inputs) = 0;
    /// A variable's bytes. @errors std::runtime_error: not of that size
    [[nodiscard]] virtual std::vector<uint8_t> variable(const std::string& name,
                                                        std::size_t size) = 0;
};

/// The back end's representation, interpreted.
class InterpretedMailbox final : public Mailbox {
public:
    explicit InterpretedMailbox(const toolchain::codegen::Module& module);
    void reset(const Record& calibration) override;
    void step(const Record& inputs) override;
    std::vector<uint8_t> variable(const std::string& name, std::size_t size) override;

private:
    void put(const std::string& name, const Record& record);
    codegen_test::Interpreter machine_;
};

/// The image on the simulated processor.
class ImageMailbox final : public Mailbox {
public:
    explicit ImageMailbox(const toolchain::assembly::Program& program,
                          host_sim::InstructionSet set = host_sim::InstructionSet::documented);
    void reset(const Record& calibration) override;
    void step(const Record& inputs) override;
    std::vector<uint8_t> variable(const std::string& name, std::size_t size) override;
    [[nodiscard]] Machine& machine() { return machine_; }
    [[nodiscard]] uint64_t step_t() const { return step_t_; }  ///< T-states of the last step

private:
    void check_size(const std::string& name, std::size_t size) const;
    void put(const std::string& name, const Record& record);
    Machine machine_;
    uint64_t step_t_ = 0;
};

/// How often what was reached: a comparison says little about code that never ran.
struct Reached {
    std::array<uint64_t, 6> modes = {};
    std::array<uint64_t, 8> events = {};
    std::array<uint64_t, 8> faults = {};

    void add(const rover::Estimates& estimates);
};

struct Comparison {
    uint64_t steps = 0;
    uint64_t cycles = 0;  ///< of slip and sinkage
    Reached reached{};
    std::string difference{};  ///< the first one, with seed, step and field; empty: none
};

/// Runs both until so many slip-and-sinkage cycles have come; compares every byte of commands and
/// state after every step.
/// @param after_step  told whether the step ran a cycle
[[nodiscard]] Comparison compare(Mailbox& target, uint64_t seed, uint64_t cycles,
                                 const std::function<void(bool)>& after_step);

}  // namespace target_test
