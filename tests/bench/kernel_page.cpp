// kernel_page.cpp - see kernel_page.hpp.
#include "tests/bench/kernel_page.hpp"

#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string_view>

namespace bench {

namespace {

struct Page {
    std::string text;
    std::size_t first = 0;  ///< behind the first mark
    std::size_t last = 0;   ///< of the second one
};

Page load(const std::string& file) {
    std::ifstream stream(file);
    std::ostringstream content;
    content << stream.rdbuf();
    Page page{.text = content.str()};
    const std::size_t begin = page.text.find(kPageBegin);
    const std::size_t end = page.text.find(kPageEnd);
    if (!stream || begin == std::string::npos || end == std::string::npos || end < begin) {
        throw std::runtime_error(file + " has no place for the tables");
    }
    page.first = begin + std::string_view(kPageBegin).size();
    page.last = end;
    return page;
}

}  // namespace

std::string read_page(const std::string& file) {
    const Page page = load(file);
    return page.text.substr(page.first, page.last - page.first);
}

void write_page(const std::string& file, const std::string& tables) {
    Page page = load(file);
    page.text.replace(page.first, page.last - page.first, tables);
    std::ofstream stream(file);
    stream << page.text;
    if (!stream.flush()) throw std::runtime_error(file + " cannot be written");
}

}  // namespace bench
