// The page in headless Chromium: it draws, without a script error, a request or sideways scrolling.
// Set ROVER_REPORT_SCREENSHOTS to a folder to keep the pages and pictures of them.
#include <gmock/gmock.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>

#include "browser.hpp"
#include "synthetic_drive.hpp"
#include "tools/report/report.hpp"

namespace {

using report_test::Browser;

/// For each chart: its size, and how many pixels differ from the background and from grey, in all
/// of its canvases together.
constexpr const char* kMeasureCharts = R"js(
return Array.from(document.querySelectorAll('.chart')).map((chart) => {
  const box = chart.getBoundingClientRect();
  let drawn = 0, coloured = 0;
  const canvases = chart.querySelectorAll('canvas');
  for (const canvas of canvases) {
    if (!canvas.width || !canvas.height) continue;
    const pixels = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data;
    for (let i = 0; i < pixels.length; i += 4) {
      if (pixels[i + 3] === 0) continue;
      ++drawn;
      const spread = Math.max(pixels[i], pixels[i + 1], pixels[i + 2]) -
                     Math.min(pixels[i], pixels[i + 1], pixels[i + 2]);
      if (spread > 40) ++coloured;
    }
  }
  return {id: chart.id, canvases: canvases.length, width: box.width, right: box.right,
          height: box.height, drawn, coloured};
});)js";

class ReportInBrowser : public testing::Test {
protected:
    static void SetUpTestSuite() {
        try {
            browser = std::make_unique<Browser>();
        } catch (const std::exception& error) {
            start_error = error.what();
        }
        const char* kept = std::getenv("ROVER_REPORT_SCREENSHOTS");
        folder = kept != nullptr ? std::filesystem::path(kept)
                                 : std::filesystem::path(testing::TempDir()) /
                                       ("rover85-report-" + std::to_string(getpid()));
        std::filesystem::create_directories(folder);
    }
    static void TearDownTestSuite() {
        browser.reset();
        if (std::getenv("ROVER_REPORT_SCREENSHOTS") == nullptr) std::filesystem::remove_all(folder);
    }
    void SetUp() override { ASSERT_TRUE(browser) << start_error; }

    void show(const host_sim::Log& log, const report::ReportOptions& options, int width,
              const std::string& name, const std::string& scheme = "light") {
        const auto file = folder / (name + ".html");
        report::write_report(log, options, file);
        browser->set_viewport(width, 900);
        browser->set_media("screen", scheme);
        browser->console_problems();
        browser->requests();
        browser->open("file://" + file.string());
    }
    void keep_picture(const std::string& name) {
        if (std::getenv("ROVER_REPORT_SCREENSHOTS") == nullptr) return;
        std::ofstream(folder / (name + ".png"), std::ios::binary) << browser->screenshot();
    }
    void expect_clean_page() {
        EXPECT_EQ(browser->run("return roverReport.ready"), true);
        EXPECT_TRUE(browser->run("return roverReport.errors").empty());
        EXPECT_EQ(browser->run("return performance.getEntriesByType('resource').length"), 0);
        EXPECT_EQ(browser->console_problems(), nlohmann::json::array());
        const auto requests = browser->requests();
        EXPECT_FALSE(requests.empty());  // the page itself: the probe works
        for (const std::string& address : requests) {
            const bool local = address.rfind("file://", 0) == 0 || address.rfind("data:", 0) == 0;
            EXPECT_TRUE(local) << address;
        }
    }
    void expect_fits(int width) {
        EXPECT_EQ(browser->run("return innerWidth"), width);
        EXPECT_LE(browser->run("return document.scrollingElement.scrollWidth").get<int>(), width);
    }
    void expect_charts_drawn(std::size_t count, int width) {
        const auto charts = browser->run(kMeasureCharts);
        EXPECT_EQ(charts.size(), count) << charts.dump();
        for (const auto& chart : charts) {
            EXPECT_GE(chart.at("canvases").get<int>(), 1) << chart.dump();
            EXPECT_GE(chart.at("width").get<double>(), 0.75 * width - 120) << chart.dump();
            EXPECT_LE(chart.at("right").get<double>(), width) << chart.dump();
            EXPECT_GE(chart.at("height").get<double>(), 70) << chart.dump();
            EXPECT_GE(chart.at("drawn").get<int>(), 1000) << chart.dump();
            EXPECT_GE(chart.at("coloured").get<int>(), 150) << chart.dump();
        }
    }

    static inline std::unique_ptr<Browser> browser;
    static inline std::string start_error;
    static inline std::filesystem::path folder;
};

report::ReportOptions full_options() {
    report::ReportOptions options;
    options.title = "Traverse in the simulated world";
    options.command_line = "rover85 simulate --terrain fractal --roughness 0.02 --seed 7";
    options.csv_file = "traverse.csv";
    options.front_wheel_ahead_mm = 500;
    return options;
}

TEST_F(ReportInBrowser, LongDriveRendersAt1280Pixels) {
    show(report_test::full_drive(75000), full_options(), 1280, "full-1280");
    expect_clean_page();
    expect_fits(1280);
    expect_charts_drawn(8, 1280);
    keep_picture("full-1280");
}

TEST_F(ReportInBrowser, LongDriveRendersAt390Pixels) {
    show(report_test::full_drive(75000), full_options(), 390, "full-390");
    expect_clean_page();
    expect_fits(390);
    expect_charts_drawn(8, 390);
    keep_picture("full-390");
}

TEST_F(ReportInBrowser, BareVehicleRendersAtBothWidths) {
    for (const int width : {1280, 390}) {
        const std::string name = "bare-" + std::to_string(width);
        show(report_test::bare_drive(3000), {}, width, name);
        expect_clean_page();
        expect_fits(width);
        expect_charts_drawn(3, width);
        keep_picture(name);
    }
}

TEST_F(ReportInBrowser, ADriveOnTheBoardRendersAtBothWidths) {
    report::ReportOptions options = full_options();
    options.machine =
        report::Machine{"rover85 0.1.0 sources 1a2b3c4d vehicle Rocky3.2, 20062 bytes",
                        std::vector<std::uint32_t>(1500, 80'000),
                        std::vector<std::uint32_t>(1500, 18'000),
                        {{"Longest step, main line", 163'513, 307'200, "T-states"},
                         {"Time in interrupts", 15.25, 15, "%"}}};
    for (std::size_t i = 0; i < 1500; i += 7) options.machine->main_line_t[i] = 160'000;
    for (const int width : {1280, 390}) {
        const std::string name = "machine-" + std::to_string(width);
        show(report_test::full_drive(1500), options, width, name);
        expect_clean_page();
        expect_fits(width);
        expect_charts_drawn(9, width);
        keep_picture(name);
    }
}

TEST_F(ReportInBrowser, DarkPagesRenderToo) {
    show(report_test::full_drive(1500), full_options(), 1280, "dark-1280", "dark");
    expect_clean_page();
    expect_charts_drawn(8, 1280);
    const auto red = browser->run(
        "return Number(getComputedStyle(document.body).backgroundColor.match(/\\d+/)[0])");
    EXPECT_LT(red.get<int>(), 64);
    keep_picture("dark-1280");
}

TEST_F(ReportInBrowser, ZoomingOneChartZoomsAll) {
    show(report_test::full_drive(1500), full_options(), 1280, "zoom");
    browser->run("roverReport.charts[2].updateOptions({dateWindow: [10, 20]})");
    const auto windows = browser->run("return roverReport.charts.map((g) => g.xAxisRange())");
    ASSERT_EQ(windows.size(), 8u);
    for (const auto& window : windows) EXPECT_EQ(window, nlohmann::json({10, 20}));
    browser->click("#reset");
    for (const auto& window :
         browser->run("return roverReport.charts.map((g) => g.xAxisRange())")) {
        EXPECT_GT(window[1].get<double>(), 60.0);
    }
    expect_clean_page();
}

TEST_F(ReportInBrowser, AxisSwitchesBetweenPositionAndTime) {
    show(report_test::full_drive(1500), full_options(), 1280, "axis");
    browser->click("#by-time");
    expect_charts_drawn(8, 1280);
    for (const auto& window :
         browser->run("return roverReport.charts.map((g) => g.xAxisRange())")) {
        EXPECT_NEAR(window[1].get<double>(), 149.9, 0.5);  // 1500 steps of 0.1 s
    }
    expect_clean_page();
}

TEST_F(ReportInBrowser, EventsOfTheTableLeadToTheirPlace) {
    show(report_test::full_drive(1500), full_options(), 1280, "events");
    browser->click(".go[data-event=\"0\"]");
    const auto window = browser->run("return roverReport.charts[1].xAxisRange()");
    const double up_m = browser->run(
        "return JSON.parse(document.getElementById('report-data')"
        ".textContent).events[0][3]");
    EXPECT_LT(window[0].get<double>(), up_m);
    EXPECT_GT(window[1].get<double>(), up_m);
    EXPECT_LT(window[1].get<double>() - window[0].get<double>(), 20.0);
    keep_picture("events");
    expect_clean_page();
}

TEST_F(ReportInBrowser, PaperGetsNarrowLightChartsAndTheScreenGetsItsOwnBack) {
    show(report_test::full_drive(1500), full_options(), 1280, "paper", "dark");
    browser->run("roverReport.charts[0].updateOptions({dateWindow: [10, 20]})");
    const char* background =
        "return Number(getComputedStyle(document.body).backgroundColor.match(/\\d+/)[0])";
    browser->run("window.dispatchEvent(new Event('beforeprint'))");
    EXPECT_GT(browser->run(background).get<int>(), 192);
    for (const auto& chart : browser->run(kMeasureCharts)) {
        EXPECT_LE(chart.at("width").get<double>(), 680) << chart.dump();
        EXPECT_GE(chart.at("coloured").get<int>(), 150) << chart.dump();
    }
    browser->set_media("print", "light");
    keep_picture("paper");
    browser->set_media("screen", "dark");
    browser->run("window.dispatchEvent(new Event('afterprint'))");
    EXPECT_LT(browser->run(background).get<int>(), 64);
    EXPECT_EQ(browser->run("return roverReport.charts[3].xAxisRange()"), nlohmann::json({10, 20}));
    expect_charts_drawn(8, 1280);
    expect_clean_page();
}

TEST_F(ReportInBrowser, HostileStringsStayText) {
    auto log = report_test::full_drive(400);
    const std::string evil =
        "</script><script>window.hacked=1</script><img src=x onerror='window.hacked=1'>";
    log.head.notes[evil] = evil;
    log.head.vehicle = "name = \"" + evil + "\"";
    log.head.image_identity = evil;
    report::ReportOptions options;
    options.title = options.command_line = evil;
    for (const int width : {1280, 390}) {
        show(log, options, width, "hostile");
        EXPECT_EQ(browser->run("return typeof window.hacked"), "undefined");
        EXPECT_EQ(browser->run("return document.title"), evil);
        EXPECT_EQ(browser->run("return document.images.length"), 0);
        expect_clean_page();
        expect_fits(width);
    }
}

TEST_F(ReportInBrowser, EmptyLogIsAPageWithoutCharts) {
    show({}, {}, 390, "empty");
    expect_clean_page();
    expect_fits(390);
    expect_charts_drawn(0, 390);
}

// What a screen reader is given: one first heading, no level skipped, names for charts and tables.
TEST_F(ReportInBrowser, StructureIsAccessible) {
    show(report_test::full_drive(1500), full_options(), 1280, "structure");
    const auto levels = browser->run(
        "return Array.from(document.querySelectorAll('h1,h2,h3,h4')).map((h) => +h.tagName[1])");
    EXPECT_EQ(levels.at(0), 1);
    for (std::size_t index = 1; index < levels.size(); ++index) {
        EXPECT_GE(levels[index].get<int>(), 2);
        EXPECT_LE(levels[index].get<int>(), levels[index - 1].get<int>() + 1);
    }
    EXPECT_EQ(browser->run("return document.querySelectorAll('table:not(:has(caption))').length"),
              0);
    EXPECT_EQ(browser->run("return document.querySelectorAll("
                           "'.chart:not([role=img][aria-label])').length"),
              0);
    EXPECT_EQ(browser->run("return document.documentElement.lang"), "en");
}

}  // namespace
