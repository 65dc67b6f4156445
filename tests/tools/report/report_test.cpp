#include "tools/report/report.hpp"

#include <gmock/gmock.h>
#include <time.h>

#include <filesystem>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>

#include "synthetic_drive.hpp"
#include "tools/report/spans.hpp"

namespace {

using report::report_html;
using report::ReportOptions;

nlohmann::json data_of(const std::string& page) {
    const std::string mark = "id=\"report-data\">";
    const std::size_t begin = page.find(mark) + mark.size();
    return nlohmann::json::parse(page.substr(begin, page.find("</script>", begin) - begin));
}

/// Not a matcher: a failure would print the whole page.
bool has(const std::string& page, const std::string& part) {
    return page.find(part) != std::string::npos;
}

std::size_t count_of(const std::string& text, const std::string& part) {
    std::size_t count = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
        ++count;
    }
    return count;
}

TEST(Report, SameLogGivesTheSameBytes) {
    const auto log = report_test::full_drive(2000);
    EXPECT_EQ(report_html(log, {}), report_html(log, {}));
}

/// Processor time of this thread: what a busy machine gives to others is not ours.
double thread_seconds() {
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

// The limit holds for optimised builds without sanitizers; the best of five is judged.
TEST(Report, SeventyFiveThousandStepsAreFastAndSmall) {
    const auto log = report_test::full_drive(75000);
    double best_s = 1e9;
    std::size_t size = 0;
    for (int attempt = 0; attempt < 5; ++attempt) {
        const double start_s = thread_seconds();
        size = report_html(log, {}).size();
        best_s = std::min(best_s, thread_seconds() - start_s);
    }
    std::cout << "report of 75,000 steps: " << 1000.0 * best_s << " ms, "
              << static_cast<double>(size) / 1e6 << " MB\n";
    EXPECT_LE(size, 3'000'000u);
#if defined(__OPTIMIZE__) && !defined(__SANITIZE_ADDRESS__)
    EXPECT_LE(best_s, 0.15);
#endif
}

TEST(Report, EveryAlarmOfALongLogIsInThePage) {
    const auto page = report_html(report_test::full_drive(75000), {});
    const auto data = data_of(page);
    // 20 to 23 m, the single step at 4/5 of 62.5 m, and the sinkage alarm at 40 to 42 m.
    std::vector<double> slip_m, sinkage_m;
    for (const auto& event : data["events"]) {
        if (event[0] == 0) slip_m.push_back(event[3]);
        if (event[0] == 1) sinkage_m.push_back(event[3]);
    }
    ASSERT_EQ(slip_m.size(), 2u);
    EXPECT_NEAR(slip_m[0], 20.0, 0.01);
    EXPECT_NEAR(slip_m[1], 50.0, 0.01);
    ASSERT_EQ(sinkage_m.size(), 1u);
    EXPECT_NEAR(sinkage_m[0], 40.0, 0.01);
    for (const auto& lane : data["lanes"]) {
        EXPECT_FALSE(lane["spans"].empty()) << lane["text"];
    }
    EXPECT_TRUE(has(page, "thinned from 75,000 logged steps"));
}

TEST(Report, ChartsKeepTheGreatestSinkageOfEveryStep) {
    auto log = report_test::full_drive(75000);
    log.steps[54321].estimates->sinkage_q4_mm = 16 * 777;
    const auto data = data_of(report_html(log, {}));
    for (const auto& chart : data["charts"]) {
        EXPECT_LE(chart["time"].size(), ReportOptions{}.rows_per_chart_max);
        if (chart["id"] != "sinkage") continue;
        double greatest = 0;
        for (const auto& value : chart["series"][0]["values"]) {
            if (value.is_number()) greatest = std::max(greatest, value.get<double>());
        }
        EXPECT_DOUBLE_EQ(greatest, 777.0);
    }
}

TEST(Report, ShortLogsAreDrawnWhole) {
    const auto page = report_html(report_test::full_drive(500), {});
    const auto data = data_of(page);
    for (const auto& chart : data["charts"]) EXPECT_EQ(chart["time"].size(), 500u);
    EXPECT_TRUE(has(page, "draw every logged step"));
    EXPECT_FALSE(has(page, "thinned"));
}

// Where the front wheel is 500 mm ahead, what it meets at x is drawn at x + 0.5 m: the generator's
// front and rear surfaces are the same curve, so after the move they agree.
TEST(Report, FrontWheelTrackIsDrawnWhereTheFrontWheelWas) {
    const auto log = report_test::full_drive(3000);
    ReportOptions options;
    options.front_wheel_ahead_mm = 500.0;
    const auto charts = data_of(report_html(log, options))["charts"];
    ASSERT_EQ(charts[0]["id"], "ground");
    const auto& front = charts[0]["series"][1]["by_place"];
    const auto& rear = charts[0]["series"][2]["values"];
    int compared = 0;
    for (std::size_t row = 0; row < front.size(); ++row) {
        if (!front[row].is_number()) continue;
        EXPECT_NEAR(front[row].get<double>(), rear[row].get<double>(), 0.0015) << row;
        ++compared;
    }
    EXPECT_GT(compared, 2900);
    EXPECT_LT(compared, 3000);  // nothing is known of the first half metre
}

TEST(Report, TellsWhatAVehicleWithoutSuspensionCannotKnow) {
    const auto page = report_html(report_test::bare_drive(1000), {});
    EXPECT_TRUE(has(page, "Not available on this vehicle"));
    EXPECT_TRUE(has(page, "<li><strong>sinkage</strong>: needs "));
    EXPECT_TRUE(has(page, "no true position"));
    const auto data = data_of(page);
    for (const auto& chart : data["charts"]) {
        EXPECT_THAT(std::string(chart["id"]), testing::AnyOf("attitude", "wheels"));
    }
    EXPECT_FALSE(
        has(report_html(report_test::full_drive(1000), {}), "Not available on this vehicle"));
}

TEST(Report, EmptyLogGivesAPageThatSaysSo) {
    const auto page = report_html({}, {});
    EXPECT_TRUE(has(page, "The log is empty"));
    EXPECT_TRUE(data_of(page)["charts"].empty());
    EXPECT_FALSE(has(page, "nan mm") || has(page, "nan s") || has(page, ":nan"));
}

TEST(Report, NoStringOfTheLogBecomesMarkup) {
    const std::string evil = "</script><script>alert(1)</script><img src=x onerror=alert(2)>\"'";
    auto log = report_test::full_drive(100);
    log.head.notes = {{evil, evil}};
    log.head.vehicle = "name = \"</title><script>alert(3)</script>\"\n" + evil;
    log.head.image_identity = evil;
    ReportOptions options;
    options.title = options.command_line = options.csv_file = evil;
    options.rows_per_chart_max = 10;
    const auto page = report_html(log, options);
    const auto plain = report_html(report_test::full_drive(100), {});
    EXPECT_EQ(count_of(page, "<script"), count_of(plain, "<script"));
    EXPECT_EQ(count_of(page, "</script"), count_of(plain, "</script"));
    EXPECT_EQ(count_of(page, "<img"), 0u);
    EXPECT_TRUE(has(page, "&lt;/script&gt;&lt;script&gt;alert(1)"));
    EXPECT_TRUE(data_of(page).is_object());
}

TEST(Report, AsksNobodyForAnything) {
    const auto page = report_html(report_test::full_drive(100), {});
    EXPECT_TRUE(has(page, "default-src 'none'"));
    for (const char* forbidden : {"src=\"http", "href=\"http", "src=\"//", "@import", "url(http",
                                  "sourceMappingURL", "<iframe", "<base"}) {
        EXPECT_EQ(count_of(page, forbidden), 0u) << forbidden;
    }
}

TEST(Spans, TheLeastImportantAreLeftOutFirst) {
    const std::vector<report::Lane> lanes = {
        {report::LaneKind::slip_alarm, "Slip alarm", {0, 0, 0, 1, 1, 0, 1}},
        {report::LaneKind::tick_gap, "Ticks missing", {1, 0, 1, 0, 0, 0, 0}}};
    std::size_t left_out = 99;
    auto spans = report::spans_of(lanes, 10, left_out);
    EXPECT_EQ(left_out, 0u);
    ASSERT_EQ(spans.size(), 4u);
    EXPECT_EQ(spans[0].begin, 0u);
    EXPECT_EQ(spans[2].begin, 3u);
    EXPECT_EQ(spans[2].end, 5u);
    EXPECT_FALSE(spans[2].open);
    EXPECT_TRUE(spans[3].open);
    spans = report::spans_of(lanes, 3, left_out);
    EXPECT_EQ(left_out, 1u);
    ASSERT_EQ(spans.size(), 3u);
    EXPECT_EQ(spans[0].begin, 0u);  // of the two tick gaps the later one went
    EXPECT_EQ(spans[1].begin, 3u);
}

TEST(WriteReport, WritesTheFileOrSaysWhyNot) {
    const auto file = std::filesystem::path(testing::TempDir()) / "rover85_report_test.html";
    const auto log = report_test::full_drive(100);
    report::write_report(log, {}, file);
    EXPECT_EQ(std::filesystem::file_size(file), report_html(log, {}).size());
    std::filesystem::remove(file);
    EXPECT_THROW(report::write_report(log, {}, "/nonexistent-folder/report.html"),
                 std::runtime_error);
}

}  // namespace
