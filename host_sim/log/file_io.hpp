// file_io.hpp - whole files in and out, with errors that say what to do.
// Internal     to host_sim_log.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace host_sim::detail {

/// The content of a file (or pipe). @errors  LogError: missing, a directory, unreadable, > 2 GiB
std::string read_file(const std::filesystem::path& path);

enum class Durability : bool { process, power };  ///< power: synced to the disk before the rename

/// Writes `path` whole or not at all: a file beside it is written, then renamed. What is not a
/// regular file (a pipe, /dev/stdout) is written directly. @errors LogError
void write_file(const std::filesystem::path& path, std::string_view bytes,
                Durability durability = Durability::process);

/// Writes all bytes to an open descriptor. @return bytes written; fewer than asked: errno tells why
std::size_t write_all(int descriptor, std::string_view bytes);

/// Opens a new or emptied file for writing; -1: errno tells why.
int open_for_writing(const std::filesystem::path& path);

/// Throws the LogError for a failed system call on `path`.
[[noreturn]] void fail_system(const std::filesystem::path& path, std::string_view action,
                              int error);

}  // namespace host_sim::detail
