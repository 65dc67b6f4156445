// display.hpp - where the monitor's lines go: a block that is drawn anew in place on a terminal,
// line after line elsewhere.
// Depends on   words.hpp. Terminals understand ECMA-48.
#pragma once

#include <cstddef>
#include <ostream>
#include <string>

#include "tools/monitor/words.hpp"

namespace monitor {

class Display {
public:
    /// @param in_place  `out` is a terminal
    Display(std::ostream& out, bool in_place);
    ~Display();
    Display(const Display&) = delete;
    Display& operator=(const Display&) = delete;

    /// A message has come and is in `known`. @param line  it in words
    void show(const Known& known, const std::string& line);
    /// Something that has to stay readable: above the block, or a line of its own.
    void note(const std::string& line);

private:
    void erase();
    void draw();

    std::ostream& out_;
    bool in_place_;
    std::vector<std::string> block_;
    std::size_t drawn_ = 0;  ///< lines of the block that stand on the terminal
};

}  // namespace monitor
