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

#include "host_sim/image/checksum.hpp"
#include "host_sim/image/eeprom.hpp"
#include "host_sim/image/identity.hpp"
#include "tools/debug/load.hpp"
#include "tools/rover85/command_errors.hpp"

namespace {

namespace fs = std::filesystem;
using host_sim::Image;

constexpr std::size_t kBytesPerKb = 1024;

struct FlashOptions {
    std::string image, backend, out, compare;
    unsigned size_kb = 32;
    bool dry_run = false;
};

/// An image, checked, as the content of the part.
struct Prepared {
    Image image;
    host_sim::ImageIdentity identity;
    std::vector<uint8_t> content;
};

Prepared prepare(const FlashOptions& options) {
    Prepared prepared;
    prepared.image = debug_console::read_image(options.image, {});
    prepared.identity = host_sim::read_identity(prepared.image);
    // What lies behind the program in a BIN is padding; the new padding is the part's.
    Image cut;
    cut.file = prepared.image.file;
    for (std::size_t at = 0; at < prepared.identity.image_size; ++at) {
        if (prepared.image.present[at]) {
            cut.put(static_cast<uint16_t>(at), prepared.image.bytes[at]);
        }
    }
    prepared.image = std::move(cut);
    prepared.content = host_sim::eeprom_content(prepared.image, options.size_kb * kBytesPerKb);
    return prepared;
}

void print_facts(const FlashOptions& options, const Prepared& prepared) {
    const std::vector<uint8_t>& content = prepared.content;
    const std::size_t used = prepared.identity.image_size;
    std::cout << fmt::format("image     {}\n", options.image)
              << fmt::format("identity  {}\n", host_sim::describe(prepared.identity))
              << fmt::format(
                     "program   {} of {} bytes ({:.1f} %)\n", used, content.size(),
                     100.0 * static_cast<double>(used) / static_cast<double>(content.size()))
              << fmt::format(
                     "whole part, padded with FFH: CRC-16 {:04X}H, CRC-32 {:08X}H, "
                     "sum of bytes {:04X}H\n",
                     host_sim::crc16_ccitt_false(content), host_sim::crc32(content),
                     host_sim::byte_sum(content));
}

std::string byte_text(std::optional<uint8_t> byte) {
    return byte ? fmt::format("{:02X}H", *byte) : "nothing";
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
        "DIFFERS   {}: first wrong address {:04X}H: {} instead of {}; {} of {} "
        "bytes are wrong\n",
        name, mismatch->first, byte_text(mismatch->found), byte_text(mismatch->expected),
        mismatch->count, expected.size());
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

int write_and_verify(const FlashOptions& options, const Prepared& prepared) {
    const fs::path bin = options.out.empty()
                             ? fs::path(fs::path(options.image).stem().string() + "-eeprom.bin")
                             : fs::path(options.out);
    const fs::path hex = fs::path(bin).replace_extension(".hex");
    if (options.dry_run) {
        std::cout << fmt::format("dry run: {} and {} were not written\n", bin.string(),
                                 hex.string());
        return kExitPass;
    }
    const std::vector<uint8_t>& content = prepared.content;
    write_file(bin, {content.begin(), content.end()});
    write_file(hex, host_sim::write_hex(prepared.image));
    int exit_code = kExitPass;
    for (const fs::path& file : {bin, hex}) {
        exit_code = std::max(exit_code, report_comparison(file.string(), content,
                                                          content_of_file(file, content.size())));
    }
    std::cout << fmt::format("next: minipro -p AT28C256 -u -w {}\n", bin.string());
    return exit_code;
}

int flash(const FlashOptions& options) {
    if (options.backend != "file") {
        std::cerr << fmt::format(
            "rover85: flash --backend {}: is not available yet; use --backend file and an EPROM "
            "programmer (docs/guides/flashing.md)\n",
            options.backend);
        return kExitUsage;
    }
    const Prepared prepared = prepare(options);
    print_facts(options, prepared);
    if (options.compare.empty()) return write_and_verify(options, prepared);
    return report_comparison(options.compare, prepared.content,
                             content_of_file(options.compare, prepared.content.size()));
}

std::string check_output(const std::string& name) {
    return fs::path(name).extension() == ".bin" ? ""
                                                : name + " does not end in .bin; the HEX is beside";
}

void add_options(CLI::App& command, FlashOptions& options) {
    command.add_option("IMAGE", options.image, "Image with an identity block: Intel HEX or BIN")
        ->required()
        ->type_name("IMAGE");
    command
        .add_option("--backend", options.backend,
                    "file: for an EPROM programmer. serial, board: not available yet")
        ->required()
        ->check(CLI::IsMember({"file", "serial", "board"}));
    command
        .add_option("--out", options.out,
                    "BIN to write, the Intel HEX beside it [default: IMAGE-eeprom.bin, here]")
        ->type_name("FILE.bin")
        ->check(check_output);
    command.add_option("--size", options.size_kb, "Size of the part in KB")
        ->transform([](std::string text) {
            if (!text.empty() && (text.back() == 'K' || text.back() == 'k')) text.pop_back();
            return text;
        })
        ->check(CLI::IsMember({2U, 8U, 16U, 32U, 64U}))
        ->type_name("KB")
        ->capture_default_str();
    CLI::Option* dry =
        command.add_flag("--dry-run", options.dry_run, "Check the image, write nothing");
    command
        .add_option("--compare", options.compare,
                    "Write nothing; compare a file that was read from a part (minipro -r)")
        ->type_name("FILE")
        ->excludes(dry)
        ->excludes("--out");
}

}  // namespace

void add_flash_command(CLI::App& app, int& exit_code) {
    auto options = std::make_shared<FlashOptions>();
    CLI::App& command = *app.add_subcommand(
        "flash", "Check an image and write it for a memory part (docs/guides/flashing.md)");
    add_options(command, *options);
    command.footer(
        "Exit code 1: what was written or read back is not the image; the first wrong address and\n"
        "the count are printed.\n"
        "Examples:\n"
        "  rover85 flash build/bin/rover85.hex --backend file --dry-run\n"
        "  rover85 flash build/bin/rover85.hex --backend file --out rover85-eeprom.bin\n"
        "  minipro -p AT28C256 -u -w rover85-eeprom.bin\n"
        "  minipro -p AT28C256 -r from-the-part.bin\n"
        "  rover85 flash build/bin/rover85.hex --backend file --compare from-the-part.bin");
    command.callback(
        [options, &exit_code] { exit_code = guarded([&] { return flash(*options); }); });
}
