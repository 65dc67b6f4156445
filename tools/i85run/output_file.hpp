// output_file.hpp - a result file, opened before the run so that a wrong path is found at once.
#pragma once

#include <fstream>
#include <ostream>
#include <string>

namespace i85run {

/// A file that is written from the start. Every failure is a host_sim::ImageError with its name.
class OutputFile {
public:
    explicit OutputFile(std::string file);

    [[nodiscard]] std::ostream& stream() { return stream_; }

    /// Ends the file. Without it a failed write goes unnoticed.
    void close();

private:
    [[noreturn]] void fail(const char* what) const;

    std::string file_;
    std::ofstream stream_;
};

}  // namespace i85run
