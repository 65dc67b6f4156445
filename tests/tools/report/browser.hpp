// browser.hpp - a headless Chromium for tests, driven through chromedriver's WebDriver interface.
// Needs   the Debian packages chromium and chromium-driver.
#pragma once

#include <sys/types.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace report_test {

/// One browser with an empty profile of its own. All members throw std::runtime_error with what
/// chromedriver said; a missing program is reported by the name of its package.
class Browser {
public:
    Browser();
    ~Browser();
    Browser(const Browser&) = delete;
    Browser& operator=(const Browser&) = delete;

    /// Width and height of the viewport in CSS pixels, below the window's minimum too.
    void set_viewport(int width, int height);
    void set_media(const std::string& media, const std::string& colour_scheme);
    void open(const std::string& url);
    /// Runs the body of a function and gives back what it returns.
    nlohmann::json run(const std::string& script);
    void click(const std::string& css);
    /// Screen shot of the whole page as PNG bytes.
    std::string screenshot();
    /// Entries of the browser console of level SEVERE or WARNING since the last call.
    nlohmann::json console_problems();
    /// Addresses that the page asked for since the last call, the page itself included.
    std::vector<std::string> requests();

private:
    nlohmann::json command(const std::string& path, const nlohmann::json& body);
    nlohmann::json cdp(const std::string& name, const nlohmann::json& parameters);
    nlohmann::json log_entries(const std::string& type);
    void stop();

    pid_t driver_ = -1;
    int port_ = 0;
    std::string profile_;
    std::string session_;
};

}  // namespace report_test
