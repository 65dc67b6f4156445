// markdown.hpp - links, headings and commands of a Markdown page.
// Bounds       inline links `[text](target)` and fenced code blocks; no reference links, no HTML.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace tidy {

/// A piece of a page with the line it stands on, counted from 1.
struct PageItem {
    int line = 0;
    std::string text;
};

/// Targets of all inline links outside code, as written.
std::vector<PageItem> link_targets(std::string_view page);

/// Anchors of all headings as GitHub forms them: lower case, punctuation dropped, blanks to '-'.
std::vector<std::string> heading_anchors(std::string_view page);

/// First words of the command lines in fenced code that begin with `./` or `build/bin/`, a leading
/// `$ ` removed.
std::vector<PageItem> command_programs(std::string_view page);

}  // namespace tidy
