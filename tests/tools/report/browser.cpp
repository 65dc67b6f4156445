#include "browser.hpp"

#include <fcntl.h>
#include <httplib.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <thread>
#include <vector>

namespace report_test {
namespace {

constexpr const char* kDriver = "/usr/bin/chromedriver";
constexpr const char* kChromium = "/usr/bin/chromium";

void demand(const char* program, const char* package) {
    if (access(program, X_OK) != 0) {
        throw std::runtime_error(std::string(program) +
                                 " is missing. Install it with: apt-get install " + package);
    }
}

/// Starts chromedriver on a free port, in a process group of its own, with its output in a file.
pid_t start_driver(const std::string& output) {
    const pid_t child = fork();
    if (child < 0) throw std::runtime_error("fork failed");
    if (child == 0) {
        setpgid(0, 0);
        const int file = open(output.c_str(), O_CREAT | O_WRONLY | O_APPEND, 0600);
        dup2(file, STDOUT_FILENO);
        dup2(file, STDERR_FILENO);
        execl(kDriver, kDriver, "--port=0", static_cast<char*>(nullptr));
        _exit(127);
    }
    return child;
}

/// The port that chromedriver prints once it listens; waits for it at most half a minute.
int read_port(const std::string& output) {
    std::string line, said;
    for (int attempt = 0; attempt < 600; ++attempt) {
        said.clear();
        for (std::ifstream file(output); std::getline(file, line);) {
            said += line + "\n";
            int port = 0;
            char dot = 0;  // the line is complete
            if (std::sscanf(line.c_str(), "ChromeDriver was started successfully on port %d%c",
                            &port, &dot) == 2) {
                return port;
            }
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    throw std::runtime_error("chromedriver did not start within 30 s: " + said);
}

}  // namespace

Browser::Browser() {
    demand(kChromium, "chromium");
    demand(kDriver, "chromium-driver");
    std::string name = (std::filesystem::temp_directory_path() / "rover85-browser-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("cannot make a folder in /tmp");
    profile_ = name;
    const std::string output = profile_ + "/chromedriver.txt";
    driver_ = start_driver(output);
    try {
        port_ = read_port(output);
        const nlohmann::json arguments = {"--headless=new",
                                          "--no-sandbox",
                                          "--disable-gpu",
                                          "--disable-quic",
                                          "--no-first-run",
                                          "--disable-background-networking",
                                          "--disable-component-update",
                                          "--disable-sync",
                                          "--disable-dev-shm-usage",
                                          "--hide-scrollbars",
                                          "--user-data-dir=" + profile_ + "/profile",
                                          "--window-size=1280,900"};
        const nlohmann::json body = {
            {"capabilities",
             {{"alwaysMatch",
               {{"goog:chromeOptions", {{"binary", kChromium}, {"args", arguments}}},
                {"goog:loggingPrefs", {{"browser", "ALL"}, {"performance", "ALL"}}}}}}}};
        session_ = "/session";
        const auto reply = command("", body);
        session_ = "/session/" + reply.at("sessionId").get<std::string>();
    } catch (...) {
        stop();
        throw;
    }
}

Browser::~Browser() {
    httplib::Client client("127.0.0.1", port_);
    client.set_read_timeout(20);
    client.Delete(session_.c_str());
    stop();
}

void Browser::stop() {
    if (driver_ > 0) {
        kill(-driver_, SIGTERM);
        waitpid(driver_, nullptr, 0);
    }
    std::error_code ignored;
    std::filesystem::remove_all(profile_, ignored);
}

nlohmann::json Browser::command(const std::string& path, const nlohmann::json& body) {
    httplib::Client client("127.0.0.1", port_);
    client.set_read_timeout(90);
    const auto reply = client.Post((session_ + path).c_str(), body.dump(), "application/json");
    if (!reply) throw std::runtime_error("chromedriver does not answer to " + path);
    const auto value = nlohmann::json::parse(reply->body).at("value");
    if (reply->status != 200) throw std::runtime_error(path + ": " + value.dump());
    return value;
}

nlohmann::json Browser::cdp(const std::string& name, const nlohmann::json& parameters) {
    return command("/goog/cdp/execute", {{"cmd", name}, {"params", parameters}});
}

void Browser::set_viewport(int width, int height) {
    cdp("Emulation.setDeviceMetricsOverride",
        {{"width", width}, {"height", height}, {"deviceScaleFactor", 1}, {"mobile", width < 600}});
}

void Browser::set_media(const std::string& media, const std::string& colour_scheme) {
    const nlohmann::json feature = {{"name", "prefers-color-scheme"}, {"value", colour_scheme}};
    cdp("Emulation.setEmulatedMedia",
        {{"media", media}, {"features", nlohmann::json::array({feature})}});
}

void Browser::open(const std::string& url) {
    command("/url", {{"url", url}});
}

nlohmann::json Browser::run(const std::string& script) {
    return command("/execute/sync", {{"script", script}, {"args", nlohmann::json::array()}});
}

void Browser::click(const std::string& css) {
    const auto element = command("/element", {{"using", "css selector"}, {"value", css}});
    const std::string id = element.begin().value();
    command("/element/" + id + "/click", nlohmann::json::object());
}

std::string Browser::screenshot() {
    const auto reply =
        cdp("Page.captureScreenshot", {{"format", "png"}, {"captureBeyondViewport", true}});
    const std::string text = reply.at("data");
    std::string bytes;
    unsigned bits = 0;
    int count = 0;
    const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (const char c : text) {
        const std::size_t digit = digits.find(c);
        if (digit == std::string::npos) break;
        bits = (bits << 6) | static_cast<unsigned>(digit);
        count += 6;
        if (count >= 8) {
            count -= 8;
            bytes += static_cast<char>((bits >> count) & 0xFF);
        }
    }
    return bytes;
}

nlohmann::json Browser::log_entries(const std::string& type) {
    return command("/se/log", {{"type", type}});
}

nlohmann::json Browser::console_problems() {
    nlohmann::json problems = nlohmann::json::array();
    for (const auto& entry : log_entries("browser")) {
        if (entry.at("level") == "SEVERE" || entry.at("level") == "WARNING")
            problems.push_back(entry);
    }
    return problems;
}

std::vector<std::string> Browser::requests() {
    std::vector<std::string> addresses;
    for (const auto& entry : log_entries("performance")) {
        const auto message =
            nlohmann::json::parse(entry.at("message").get<std::string>()).at("message");
        if (message.at("method") != "Network.requestWillBeSent") continue;
        addresses.push_back(message.at("params").at("request").at("url"));
    }
    return addresses;
}

}  // namespace report_test
