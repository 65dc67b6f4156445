// flash_command.cpp - see flash_command.hpp.
#include "tools/rover85/flash_command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "host_sim/bind/flasher.hpp"
#include "host_sim/image/board_image.hpp"
#include "host_sim/image/checksum.hpp"
#include "host_sim/image/eeprom.hpp"
#include "host_sim/image/identity.hpp"
#include "tools/debug/load.hpp"
#include "tools/rover85/command_errors.hpp"
#include "tools/rover85/flash_link.hpp"
#include "tools/rover85/image_beside.hpp"

namespace {

namespace fs = std::filesystem;
namespace loader = rover::loader;
using host_sim::Image;

constexpr std::size_t kBytesPerKb = 1024;

struct Options {
    std::string image, backend, out, compare;
    unsigned size_kb = 32;
    LinkFlash link;
};

/// An image, checked, as the content of the part.
struct Prepared {
    Image image;
    host_sim::ImageIdentity identity;
    std::vector<uint8_t> content;
};

/// An image without what a padded BIN has in its gaps.
Image without_padding(const Image& image) {
    Image cut;
    cut.file = image.file;
    for (std::size_t at = 0; at <= hal::rb85::kEepromLast; ++at) {
        if (image.present[at] && image.bytes[at] != host_sim::kErasedByte) {
            cut.put(static_cast<uint16_t>(at), image.bytes[at]);
        }
    }
    return cut;
}

Prepared prepare(const Options& options) {
    Prepared prepared;
    prepared.image = debug_console::read_image(options.image, {});
    prepared.identity = host_sim::read_identity(prepared.image);
    return prepared;
}

void print_image(const Options& options, const Prepared& prepared) {
    const std::size_t used = host_sim::byte_count(prepared.identity);
    constexpr std::size_t kPlace = loader::kRecordPage - loader::kApplicationFirst;
    std::cout << fmt::format("image     {}\n", options.image)
              << fmt::format("identity  {}\n", host_sim::describe(prepared.identity))
              << fmt::format("program   {} of {} bytes ({:.1f} %)\n", used, kPlace,
                             100.0 * static_cast<double>(used) / kPlace);
}

/// Loader, application and boot record as a part.
void fill_part(const Options& options, Prepared& prepared) {
    if (!prepared.image.present[0] ||
        prepared.image.bytes[loader::kRecordPage] == host_sim::kErasedByte) {
        throw host_sim::ImageError(options.image, 0, "has no loader or no boot record",
                                   "give the image that the build has made");
    }
    prepared.content = host_sim::eeprom_content(prepared.image, options.size_kb * kBytesPerKb);
    const std::vector<uint8_t>& content = prepared.content;
    std::cout << fmt::format(
        "whole part, padded with FFH: CRC-16 {:04X}H, CRC-32 {:08X}H, sum of bytes {:04X}H\n",
        host_sim::crc16_ccitt_false(content), host_sim::crc32(content),
        host_sim::byte_sum(content));
}

std::string byte_text(std::optional<uint8_t> byte) {
    return byte ? fmt::format("{:02X}H", *byte) : "nothing";
}

/// What the wrong bytes tell; bytes that are missing tell nothing.
std::string cause_of(std::span<const uint8_t> expected, std::span<const uint8_t> found) {
    std::vector<uint8_t> wanted, read;
    for (std::size_t i = 0; i < std::min(expected.size(), found.size()); ++i) {
        if (expected[i] == found[i]) continue;
        wanted.push_back(expected[i]);
        read.push_back(found[i]);
    }
    if (read.empty()) return "the file is not of the part's size";
    return host_sim::likely_cause(wanted, read);
}

/// @return  kExitPass or kExitDifference, with what is wrong
int report_comparison(const std::string& name, std::span<const uint8_t> expected,
                      std::span<const uint8_t> found) {
    const auto mismatch = host_sim::compare_content(expected, found);
    if (!mismatch) {
        std::cout << fmt::format("verified  {}: all {} bytes\n", name, expected.size());
        return kExitPass;
    }
    std::cout << fmt::format(
        "DIFFERS   {}: first wrong address {:04X}H: {} instead of {}; {} of {} bytes are wrong; "
        "likely cause: {}\n",
        name, mismatch->first, byte_text(mismatch->found), byte_text(mismatch->expected),
        mismatch->count, expected.size(), cause_of(expected, found));
    return kExitDifference;
}

std::vector<uint8_t> content_of_file(const fs::path& file, std::size_t size) {
    const std::string text = host_sim::read_image_file(file);
    if (text.starts_with(':')) {
        return host_sim::eeprom_content(host_sim::read_hex(text, file.string()), size);
    }
    return {text.begin(), text.end()};
}

void write_file(const fs::path& file, const std::string& content) {
    std::ofstream stream(file, std::ios::binary | std::ios::trunc);
    stream << content;
    stream.close();
    if (!stream) {
        throw host_sim::ImageError(file.string(), 0, "cannot be written",
                                   "check path, permissions and space");
    }
}

int write_and_verify(const Options& options, const Prepared& prepared) {
    const fs::path bin = options.out.empty()
                             ? fs::path(fs::path(options.image).stem().string() + "-eeprom.bin")
                             : fs::path(options.out);
    const fs::path hex = fs::path(bin).replace_extension(".hex");
    if (options.link.dry_run) {
        std::cout << fmt::format("dry run: {} and {} were not written\n", bin.string(),
                                 hex.string());
        return kExitPass;
    }
    const std::vector<uint8_t>& content = prepared.content;
    write_file(bin, {content.begin(), content.end()});
    write_file(hex, host_sim::write_hex(without_padding(prepared.image)));
    int exit_code = kExitPass;
    for (const fs::path& file : {bin, hex}) {
        exit_code = std::max(exit_code, report_comparison(file.string(), content,
                                                          content_of_file(file, content.size())));
    }
    std::cout << fmt::format("next: minipro -p AT28C256 -u -w {}\n", bin.string());
    return exit_code;
}

int flash_file(const Options& options, Prepared& prepared) {
    fill_part(options, prepared);
    if (options.compare.empty()) return write_and_verify(options, prepared);
    return report_comparison(options.compare, prepared.content,
                             content_of_file(options.compare, prepared.content.size()));
}

int flash(Options& options) {
    if (options.image.empty()) options.image = image_beside().string();
    if (options.backend == "board" && options.link.eeprom.empty()) {
        std::cerr << "rover85: flash --backend board: needs --eeprom FILE.bin, where the simulated "
                     "board keeps its EEPROM\n";
        return kExitUsage;
    }
    Prepared prepared = prepare(options);
    print_image(options, prepared);
    if (options.backend == "file") return flash_file(options, prepared);
    if (options.backend == "serial") return flash_serial(prepared.image, options.link);
    return flash_board(prepared.image, options.link);
}

std::string check_output(const std::string& name) {
    return fs::path(name).extension() == ".bin" ? ""
                                                : name + " does not end in .bin; the HEX is beside";
}

void add_file_options(CLI::App& command, Options& options) {
    CLI::Option* out =
        command
            .add_option("--out", options.out,
                        "file: BIN to write, the Intel HEX beside it [default: IMAGE-eeprom.bin, "
                        "here]")
            ->type_name("FILE.bin")
            ->check(check_output);
    command.add_option("--size", options.size_kb, "file: size of the part in KB")
        ->transform([](std::string text) {
            if (!text.empty() && (text.back() == 'K' || text.back() == 'k')) text.pop_back();
            return text;
        })
        ->check(CLI::IsMember({32U, 64U}))
        ->type_name("KB")
        ->capture_default_str();
    command
        .add_option("--compare", options.compare,
                    "file: write nothing; compare a file that was read from a part (minipro -r)")
        ->type_name("FILE")
        ->excludes(out)
        ->excludes("--dry-run");
}

void add_link_options(CLI::App& command, LinkFlash& link) {
    command
        .add_option("--port", link.port,
                    "serial: the PC's port, such as /dev/ttyUSB0 [default: the only one there is]")
        ->type_name("PATH");
    command
        .add_option("--eeprom", link.eeprom,
                    "board: file with the content of the simulated board's EEPROM; made if it is "
                    "not there, with the loader alone")
        ->type_name("FILE.bin");
    command
        .add_flag("--verify", link.verify_only,
                  "serial, board: write nothing; compare the board's EEPROM with the image")
        ->excludes("--dry-run");
    command.add_flag("--all", link.write_all,
                     "serial, board: send every page, also those that are right already");
    command.add_flag("--any-vehicle", link.any_vehicle,
                     "serial, board: accept an image for another vehicle than the board's");
    command.add_flag("--stay", link.stay, "serial, board: leave the board in the loader");
    command.add_option("--wait", link.patience_s, "serial, board: seconds to wait for the loader")
        ->check(CLI::Range(1, 3600))
        ->type_name("SECONDS")
        ->capture_default_str();
}

void add_options(CLI::App& command, Options& options) {
    command
        .add_option("IMAGE", options.image,
                    "Image with an identity block: Intel HEX or BIN [default: rover85.hex beside "
                    "this program]")
        ->type_name("IMAGE");
    command
        .add_option("--backend", options.backend,
                    "serial: through the board's loader. board: the same with a simulated board. "
                    "file: for an EPROM programmer")
        ->required()
        ->check(CLI::IsMember({"file", "serial", "board"}));
    command.add_flag("--dry-run", options.link.dry_run,
                     "Check the image, see who answers, write nothing");
    add_file_options(command, options);
    add_link_options(command, options.link);
}

}  // namespace

void add_flash_command(CLI::App& app, int& exit_code) {
    auto options = std::make_shared<Options>();
    CLI::App& command = *app.add_subcommand(
        "flash",
        "Bring an image into a board, over its serial line or by an EPROM programmer "
        "(docs/guides/flashing.md)");
    add_options(command, *options);
    command.footer(
        "A transfer that breaks leaves a board whose loader answers: run the same command again,\n"
        "it goes on where it stopped.\n"
        "Exit code 1: what was written or read back is not the image (first wrong address, count,\n"
        "likely cause), or the image does not answer. 3: the image, the port or the board "
        "refused.\n"
        "Examples:\n"
        "  rover85 flash --backend serial --port /dev/ttyUSB0\n"
        "  rover85 flash --backend serial --port /dev/ttyUSB0 --verify\n"
        "  rover85 flash build/bin/rover85.hex --backend board --eeprom board.bin\n"
        "  rover85 flash --backend file --out rover85-eeprom.bin\n"
        "  minipro -p AT28C256 -u -w rover85-eeprom.bin\n"
        "  minipro -p AT28C256 -r from-the-part.bin\n"
        "  rover85 flash --backend file --compare from-the-part.bin");
    command.callback(
        [options, &exit_code] { exit_code = guarded([&] { return flash(*options); }); });
}
