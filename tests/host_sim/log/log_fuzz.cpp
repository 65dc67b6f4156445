// log_fuzz.cpp - libFuzzer target for the log readers. Whatever the bytes: no crash, no error but
// LogError; what is accepted survives rewriting in both formats; what recover keeps reads back.
// Run by       ctest -L fuzz: `log_fuzz --seeds FOLDER` writes the corpus, then one run per reader.
// Readers      LOG_FUZZ_READER, else the first byte of the input: 'r' .rlog, 'c' CSV, 's' salvage,
//              'f' .rlog whose checksums are put right first, so that fuzzing gets past them.
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <string_view>

#include "host_sim/log/log_io.hpp"
#include "log_samples.hpp"
#include "rlog_builder.hpp"

namespace {

using host_sim::Log;
using host_sim::LogError;

void require(bool condition, const char* claim) {
    if (condition) return;
    std::fprintf(stderr, "property broken: %s\n", claim);
    std::abort();
}

/// LogErrors must be one line that ends in advice.
void check_message(const LogError& error) {
    const std::string_view what = error.what();
    require(what.starts_with("fuzz"), "the message names the file");
    require(what.find('\n') == std::string_view::npos, "the message is one line");
    require(what.find("; ") != std::string_view::npos, "the message gives advice");
    require(error.line() == 0 || error.byte_offset() < 0, "one place, not two");
}

void check_rewriting(const Log& log) {
    const std::string bytes = host_sim::encode_rlog(log);
    require(log_test::same(host_sim::read_rlog(bytes, "fuzz"), log), "rlog keeps the log");
    const Log from_csv = host_sim::read_csv(host_sim::encode_csv(log), "fuzz");
    require(log_test::same(from_csv, log) && !from_csv.unverified, "CSV keeps the log");
    require(host_sim::encode_rlog(from_csv) == bytes, "one log has one encoding");
}

void check_salvage(std::string_view bytes) {
    host_sim::Recovery recovery;
    const std::string_view kept = host_sim::salvage_rlog(bytes, "fuzz", recovery);
    require(kept == bytes.substr(0, recovery.kept_bytes), "salvage keeps a leading part");
    require(kept.size() + recovery.dropped_bytes == bytes.size(), "every byte is accounted for");
    require(recovery.reason.empty() == (recovery.dropped_bytes == 0), "a loss has a reason");
    require(host_sim::read_rlog(kept, "fuzz").steps.size() == recovery.steps, "salvage reads back");
}

/// Rewrites header, sequence numbers and checksums of what looks like records.
std::string with_right_checksums(std::string_view bytes) {
    const auto number = [&bytes](std::size_t at, std::size_t size) {
        std::size_t value = 0;
        for (std::size_t i = size; i-- > 0;) {
            value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
        }
        return value;
    };
    log_test::RlogBuilder builder;
    std::size_t at = 16;
    while (at + 13 <= bytes.size()) {
        const std::size_t size = std::min(number(at, 4), bytes.size() - at - 13);
        builder.record(static_cast<std::uint8_t>(bytes[at + 8]), bytes.substr(at + 9, size));
        at += size + 13;
    }
    return builder.bytes;
}

void run_one(char which, std::string_view bytes) {
    try {
        if (which == 'c') {
            check_rewriting(host_sim::read_csv(bytes, "fuzz"));
        } else if (which == 's') {
            check_salvage(bytes);
        } else if (which == 'f') {
            const std::string fixed = with_right_checksums(bytes);
            check_salvage(fixed);
            check_rewriting(host_sim::read_rlog(fixed, "fuzz"));
        } else {
            check_rewriting(host_sim::read_rlog(bytes, "fuzz"));
        }
    } catch (const LogError& error) {
        check_message(error);
    }
}

/// Writes small logs of both kinds, each behind the letter of its reader, and beside them the lists
/// FOLDER/r.list ... that -seed_inputs=@ takes.
class SeedFolder {
public:
    explicit SeedFolder(std::filesystem::path folder) : folder_(std::move(folder)) {
        std::filesystem::create_directories(folder_);
    }
    void write() {
        for (std::uint64_t seed = 0; seed < 24; ++seed) {
            const Log log =
                seed < 3 ? log_test::small_log(seed) : log_test::LogMaker(seed).make(seed % 4);
            const std::string bytes = host_sim::encode_rlog(log);
            put('r', bytes);
            put('f', bytes);
            put('s', bytes.substr(0, bytes.size() - seed));
            put('c', host_sim::encode_csv(log));
            put('c', host_sim::encode_csv(log, {.checksum = false}));
        }
        for (const auto& [reader, names] : lists_) {
            std::ofstream(folder_ / (std::string(1, reader) + ".list")) << names;
        }
    }

private:
    void put(char reader, const std::string& bytes) {
        const auto file = folder_ / (reader + std::to_string(++count_));
        std::ofstream(file, std::ios::binary) << reader << bytes;
        std::string& list = lists_[reader];
        list += (list.empty() ? "" : ",") + file.string();
    }

    std::filesystem::path folder_;
    std::map<char, std::string> lists_;
    int count_ = 0;
};

}  // namespace

extern "C" int LLVMFuzzerInitialize(int* count, char*** arguments) {
    if (*count == 3 && std::string_view((*arguments)[1]) == "--seeds") {
        SeedFolder((*arguments)[2]).write();
        std::exit(0);
    }
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0) return 0;
    const auto* bytes = reinterpret_cast<const char*>(data);
    const char* only = std::getenv("LOG_FUZZ_READER");  // a CTest run fuzzes one reader
    const char which = only != nullptr && *only != '\0' ? *only : bytes[0];
    run_one(which, std::string_view(bytes + 1, size - 1));
    return 0;
}
