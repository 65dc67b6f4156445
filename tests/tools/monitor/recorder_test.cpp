// Recordings read back by the log's own strict readers.
#include "tools/monitor/recorder.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "host_sim/world/vehicle.hpp"

namespace {

namespace fs = std::filesystem;
using host_sim::Log;
using host_sim::Restart;
using monitor::Elapsed;
using monitor::Recorder;
using monitor::Telemetry;

Telemetry telemetry(uint16_t step, uint64_t missing = 0, Restart restart = Restart::none) {
    Telemetry made;
    made.estimates.step_count = step;
    made.estimates.tick_count = static_cast<uint16_t>(10 * step + 3);
    made.estimates.position_q4_mm = 100 * step;
    made.estimates.mode = rover::SlipMode::tracking;
    made.step = step;
    made.missing = missing;
    made.restart = restart;
    return made;
}

host_sim::ImageIdentity identity() {
    host_sim::ImageIdentity made;
    made.version = {1, 2, 3};
    made.source_hash = 0x1234ABCD;
    made.vehicle = "Rocky3.2";
    return made;
}

class RecorderTest : public testing::TestWithParam<const char*> {
protected:
    RecorderTest() { fs::remove(path); }
    ~RecorderTest() override { fs::remove(path); }
    fs::path path = fs::temp_directory_path() / (std::string("rover85_recorder") + GetParam());
    bool is_csv = std::string(GetParam()) == ".csv";
};

TEST_P(RecorderTest, FillsWhatTelemetryTellsAndNothingElse) {
    Recorder recorder(path, "/dev/ttyUSB0");
    recorder.take(telemetry(7), Elapsed(0));
    recorder.take(identity());
    recorder.take(telemetry(8), Elapsed(100));
    recorder.take(telemetry(11, 2), Elapsed(400));
    recorder.take(telemetry(0, 0, Restart::warm), Elapsed(2450));
    recorder.take(telemetry(1), Elapsed(2550));
    recorder.close();
    EXPECT_EQ(recorder.rows(), 5u);
    const Log log = host_sim::load_log(path);
    EXPECT_FALSE(log.unverified);
    EXPECT_EQ(log.head.image_identity, "rover85 1.2.3 sources 1234abcd telemetry");
    EXPECT_EQ(log.head.vehicle, host_sim::rocky32().toml_text);
    EXPECT_EQ(log.head.notes.at("source"), "telemetry of /dev/ttyUSB0");
    ASSERT_EQ(log.steps.size(), 5u);
    const uint32_t times_ms[] = {0, 100, 400, 2400, 2500};
    for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(log.steps[i].time_ms, times_ms[i]) << i;
    EXPECT_EQ(log.steps[3].restart, Restart::warm);
    EXPECT_EQ(log.steps[2].inputs.tick_count, 113);
    EXPECT_EQ(log.steps[2].estimates->position_q4_mm, 1100);
    EXPECT_EQ(log.steps[2].estimates->mode, rover::SlipMode::tracking);
    for (const host_sim::LogStep& step : log.steps) {
        EXPECT_FALSE(step.truth);
        EXPECT_FALSE(step.commands);
        EXPECT_EQ(step.inputs.tach_present, 0);
        for (const uint16_t channel : step.inputs.adc_q4_count) EXPECT_EQ(channel, hal::kAdcAbsent);
    }
}

// What a kill leaves: the file as it is at any moment, nobody having closed it.
TEST_P(RecorderTest, IsWholeUpToItsLastRowAtAnyTime) {
    Recorder recorder(path, "x");
    EXPECT_EQ(host_sim::load_log(path).steps.size(), 0u);
    recorder.take(identity());
    for (uint16_t step = 0; step < 20; ++step) {
        recorder.take(telemetry(step), Elapsed(100 * step));
        const Log log = host_sim::load_log(path);
        EXPECT_EQ(log.steps.size(), step + 1u);
        EXPECT_EQ(log.unverified, is_csv) << "only close() writes the checksum line";
    }
}

TEST_P(RecorderTest, WaitsForTheIdentityButNotForLong) {
    Recorder recorder(path, "x");
    for (uint16_t step = 0; step <= 30; ++step) {
        EXPECT_EQ(host_sim::load_log(path).steps.size(), 0u) << step;
        recorder.take(telemetry(step), Elapsed(100 * step));
    }
    EXPECT_EQ(host_sim::load_log(path).steps.size(), 31u);
    recorder.take(identity());  // too late for the head
    recorder.take(telemetry(31), Elapsed(3100));
    recorder.close();
    const Log log = host_sim::load_log(path);
    EXPECT_EQ(log.steps.size(), 32u);
    EXPECT_EQ(log.head.image_identity, "unknown: no identity frame came");
    EXPECT_EQ(log.head.vehicle, "");
}

TEST_P(RecorderTest, AFileThatCannotBeWrittenIsHeardOfAtOnce) {
    EXPECT_THROW(Recorder("/nowhere/at/all" + std::string(GetParam()), "x"), host_sim::LogError);
}

INSTANTIATE_TEST_SUITE_P(Formats, RecorderTest, testing::Values(".rlog", ".csv"));

}  // namespace
