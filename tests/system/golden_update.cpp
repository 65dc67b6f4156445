// golden_update.cpp - drives the golden courses again and replaces their files. Review the change:
// docs/guides/testing.md, "Golden drives".
#include <cstdio>
#include <exception>

#include "host_sim/log/log_io.hpp"
#include "tests/system/golden_courses.hpp"

int main() {
    try {
        for (const system_test::GoldenCourse& course : system_test::kGoldenCourses) {
            host_sim::Log log = system_test::drive_golden(course);
            system_test::drop_telemetry(log);
            std::filesystem::create_directories(system_test::golden_file(course).parent_path());
            host_sim::write_rlog(system_test::golden_file(course), log);
            std::printf("%s: %zu steps, %lld cycles, position %.1f mm\n", course.name,
                        log.steps.size(),
                        static_cast<long long>(log.steps.back().estimates->cycle_count),
                        log.steps.back().estimates->position_q4_mm / 16.0);
        }
    } catch (const std::exception& error) {
        std::fprintf(stderr, "golden_update: %s\n", error.what());
        return 1;
    }
}
