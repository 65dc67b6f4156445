// assets.hpp - scripts and style sheets that every report carries inside itself.
// Source   the files under assets/ and the Debian package libjs-dygraphs, by embed.cmake.
#pragma once

#include <string_view>

namespace report::assets {

extern const std::string_view dygraphs_js;
extern const std::string_view dygraphs_css;
extern const std::string_view report_js;
extern const std::string_view report_css;

}  // namespace report::assets
