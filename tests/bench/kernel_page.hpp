// kernel_page.hpp - pages with figures: tables between two marks, `<!-- NAME -->` and
// `<!-- end -->`, each on a line of its own. NAME is the program that prints them.
// Depends on   the standard library.
#pragma once

#include <string>

namespace bench {

/// What stands between the marks. @errors std::runtime_error: no file, no marks
[[nodiscard]] std::string read_page(const std::string& file, const std::string& name);

/// Puts `tables` there. @errors as above
void write_page(const std::string& file, const std::string& name, const std::string& tables);

}  // namespace bench
