// vehicle_test.cpp - the built-in description, and refusals with line and key.
#include "host_sim/world/vehicle.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <string>

namespace host_sim {
namespace {

std::string rocky32_text() {
    std::ifstream file(ROVER_SOURCE_DIR "/host_sim/vehicles/rocky32.toml");
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
}

std::string error_of(const std::string& text) {
    try {
        parse_vehicle(text, "my.toml");
    } catch (const InputError& error) {
        return error.what();
    }
    return "no error";
}

// Wilcox 1994: 13 cm wheels, 25 cm between wheels, look-ahead at 60 and 80 cm.
TEST(Rocky32, HasThePapersGeometry) {
    const Vehicle vehicle = rocky32();
    EXPECT_EQ(vehicle.name, "rocky32");
    EXPECT_DOUBLE_EQ(2 * vehicle.wheel_radius_cm, 13.0);
    EXPECT_DOUBLE_EQ(vehicle.rocker_cm - vehicle.bogie_arm_cm, 25.0);
    EXPECT_DOUBLE_EQ(vehicle.rocker_cm + vehicle.bogie_arm_cm, 50.0);
    EXPECT_EQ(vehicle.range_sample_cm, (std::vector<double>{60, 80}));
}

TEST(Rocky32, BuiltInDescriptionIsTheFile) {
    EXPECT_EQ(rocky32().toml_text, rocky32_text());
    const Vehicle loaded = load_vehicle(ROVER_SOURCE_DIR "/host_sim/vehicles/rocky32.toml");
    EXPECT_EQ(loaded.rocker_cm, rocky32().rocker_cm);
}

// hal::Calibration states its nominal values; they belong to Rocky 3.2.
TEST(NominalCalibration, OfRocky32IsTheDefaultRecord) {
    const hal::Calibration made = nominal_calibration(rocky32());
    const hal::Calibration nominal;
    for (std::size_t i = 0; i < hal::kAngleChannelCount; ++i) {
        EXPECT_EQ(made.angle[i].gain_q16, nominal.angle[i].gain_q16);
        EXPECT_EQ(made.angle[i].zero_q4_count, nominal.angle[i].zero_q4_count);
    }
    EXPECT_EQ(made.wheel_radius_q4_mm, nominal.wheel_radius_q4_mm);
    EXPECT_EQ(made.tach_counts_per_turn, nominal.tach_counts_per_turn);
    EXPECT_EQ(made.tach_q16_mm_per_count, nominal.tach_q16_mm_per_count);
}

TEST(ParseVehicle, RefusesWithFileLineAndKey) {
    const std::string text = rocky32_text();
    const struct {
        const char* from;
        const char* to;
        const char* expected;
    } cases[] = {
        {"rocker_cm = 37.5 ", "rocker_cm = -1 ",
         "my.toml:7: 'linkage.rocker_cm' must be a number from"},
        {"rocker_cm = 37.5 ", "rocker_cm = \"a\" ", "my.toml:7: 'linkage.rocker_cm'"},
        {"rocker_cm = 37.5 ", "rocker_cm = nan ", "my.toml:7: 'linkage.rocker_cm'"},
        {"rocker_cm = 37.5 ", "rocker_cm = 12.0 ", "'linkage.bogie_arm_cm' must be shorter"},
        {"rocker_cm = 37.5 ", "", "'linkage.rocker_cm' is missing"},
        {"rocker_cm = 37.5 ", "roker_cm = 37.5 ",
         "my.toml:7: 'linkage.roker_cm' is not known here"},
        {"body_reference_cm = 18.75", "body_reference_cm = 40", "must not lie ahead"},
        {"[drive]", "[engine]", "'engine' is not known here"},
        {"[drive]", "[drive", "not valid TOML"},
        {"tach_counts_per_turn = 2000", "tach_counts_per_turn = 2000.5", "must be a whole number"},
        {"tach_counts_per_turn = 2000", "tach_counts_per_turn = 100", "is too small"},
        {"[60.0, 80.0]", "[80.0, 60.0]", "must rise"},
        {"[60.0, 80.0]", "[1,2,3,4,5,6,7,8,9]", "may have 8 samples"},
        {"[60.0, 80.0]", "60.0", "must be a list"},
        {"name = \"rocky32\"", "name = \"\"", "my.toml:4: 'name' must be a text"},
    };
    for (const auto& one : cases) {
        const std::string message = error_of(replaced(text, one.from, one.to));
        EXPECT_NE(message.find(one.expected), std::string::npos)
            << one.from << " -> " << one.to << ": " << message;
        EXPECT_EQ(message.find("my.toml:"), 0u) << message;
    }
    EXPECT_EQ(error_of(text), "no error");
}

TEST(LoadVehicle, SaysWhenTheFileCannotBeRead) {
    EXPECT_THROW(load_vehicle("/no/such/file.toml"), InputError);
    EXPECT_THROW(load_vehicle("/"), InputError);
}

// Any text gives a vehicle or an InputError: every prefix, and every byte replaced.
TEST(ParseVehicle, NeverCrashesOnDamagedText) {
    const std::string text = rocky32_text();
    int refused = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
        for (const char byte : {'\0', '"', '\xFF', ']'}) {
            std::string damaged = text;
            damaged[i] = byte;
            refused += error_of(damaged) == "no error" ? 0 : 1;
        }
        refused += error_of(text.substr(0, i)) == "no error" ? 0 : 1;
    }
    EXPECT_GT(refused, static_cast<int>(text.size()));
}

}  // namespace
}  // namespace host_sim
