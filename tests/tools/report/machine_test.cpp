// machine_test.cpp - the report's section about the machine, and its file.
#include "tools/report/machine.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

#include "tests/tools/report/synthetic_drive.hpp"
#include "tools/report/report.hpp"

namespace {

using report::Machine;
using testing::HasSubstr;
using testing::Not;

Machine sample() {
    return {"rover85 <1>",
            {100, 200},
            {10, 20},
            {{"ROM", 50, 100, "bytes"}, {"Time in interrupts", 15.25, 15, "%"}}};
}

// 50 of 100: the bar's whole length is 105, so 47.6 % and the mark at 95.2 %. 15.25 of 15: the
// whole is 16.01, 95.2 % and 93.7 %.
TEST(MachineSection, BarsAgainstWhatThereIsRoomFor) {
    const std::string html = report::machine_section(sample());
    EXPECT_THAT(html, HasSubstr("rover85 &lt;1&gt;"));
    EXPECT_THAT(html, HasSubstr("<span class=\"machine-fill\" style=\"width:47.6%\"></span>"
                                "<span class=\"machine-limit\" style=\"left:95.2%\"></span>"));
    EXPECT_THAT(html, HasSubstr("50 of 100 bytes"));
    EXPECT_THAT(html, HasSubstr("<span class=\"machine-fill over\" style=\"width:95.2%\"></span>"
                                "<span class=\"machine-limit\" style=\"left:93.7%\"></span>"));
    EXPECT_THAT(html, HasSubstr("15.25 of 15 %"));
}

TEST(MachineFile, ReadsBackWhatWasWritten) {
    EXPECT_EQ(report::parse_machine(report::machine_json(sample()), "machine.json"), sample());
}

TEST(MachineFile, RefusesAnythingElseByName) {
    for (const char* text : {"", "{}", "{\"format\":\"rover85 machine 2\"}",
                             "{\"format\":\"rover85 machine 1\",\"image\":3}"}) {
        try {
            (void)report::parse_machine(text, "machine.json");
            ADD_FAILURE() << text;
        } catch (const std::runtime_error& error) {
            EXPECT_THAT(error.what(), HasSubstr("machine.json: is no record of a drive"));
        }
    }
}

TEST(ReportOfTheMachine, IsThereOnlyAfterADriveOnTheBoard) {
    const host_sim::Log log = report_test::full_drive(50);
    report::ReportOptions options;
    EXPECT_THAT(report::report_html(log, options), Not(HasSubstr("id=\"machine\"")));
    options.machine = sample();
    const std::string other_length = report::report_html(log, options);
    EXPECT_THAT(other_length, HasSubstr("id=\"machine\""));
    EXPECT_THAT(other_length, Not(HasSubstr("T-states a step")))
        << "two steps of another drive are not drawn over fifty";
    options.machine->main_line_t.assign(log.steps.size(), 100);
    options.machine->interrupts_t.assign(log.steps.size(), 10);
    EXPECT_THAT(report::report_html(log, options), HasSubstr("T-states a step"));
}

}  // namespace
