// markdown.cpp - links, headings and commands of a Markdown page.
#include "tools/tidy/markdown.hpp"

#include <cctype>
#include <regex>

#include "tools/tidy/code_text.hpp"

namespace tidy {
namespace {

/// Calls `use(line number, line, is code)` for every line but the fences.
template <class Use>
void each_line(std::string_view page, Use use) {
    bool fenced = false;
    int number = 0;
    for (const std::string& line : split_lines(page)) {
        ++number;
        const std::size_t start = line.find_first_not_of(' ');
        if (start != std::string::npos && line.compare(start, 3, "```") == 0) {
            fenced = !fenced;
            continue;
        }
        use(number, line, fenced);
    }
}

/// The line without its `code` spans.
std::string without_code_spans(const std::string& line) {
    static const std::regex kSpan("`[^`]*`");
    return std::regex_replace(line, kSpan, "``");
}

std::string anchor_of(const std::string& heading) {
    std::string anchor;
    for (const char c : heading) {
        const auto byte = static_cast<unsigned char>(c);
        if (c == ' ') {
            anchor += '-';
        } else if (std::isalnum(byte) != 0 || c == '-' || c == '_' || byte >= 0x80) {
            anchor += static_cast<char>(std::tolower(byte));
        }
    }
    return anchor;
}

}  // namespace

std::vector<PageItem> link_targets(std::string_view page) {
    static const std::regex kLink(R"(\]\(([^)\s]+)[^)]*\))");
    std::vector<PageItem> targets;
    each_line(page, [&](int number, const std::string& line, bool code) {
        if (code) return;
        const std::string text = without_code_spans(line);
        for (std::sregex_iterator link(text.begin(), text.end(), kLink), end; link != end; ++link) {
            targets.push_back({number, (*link)[1].str()});
        }
    });
    return targets;
}

std::vector<std::string> heading_anchors(std::string_view page) {
    static const std::regex kHeading(R"(^#{1,6} +(.*?) *#*$)");
    std::vector<std::string> anchors;
    each_line(page, [&](int, const std::string& line, bool code) {
        std::smatch heading;
        if (!code && std::regex_match(line, heading, kHeading)) {
            anchors.push_back(anchor_of(heading[1].str()));
        }
    });
    return anchors;
}

std::vector<PageItem> command_programs(std::string_view page) {
    static const std::regex kCommand(R"(^\s*(?:\$ )?((?:\./|build/bin/)[\w./-]+))");
    std::vector<PageItem> programs;
    each_line(page, [&](int number, const std::string& line, bool code) {
        std::smatch command;
        if (code && std::regex_search(line, command, kCommand)) {
            programs.push_back({number, command[1].str()});
        }
    });
    return programs;
}

}  // namespace tidy
