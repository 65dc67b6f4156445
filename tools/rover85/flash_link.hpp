// flash_link.hpp - `rover85 flash --backend serial|board`: over a serial port, or into a simulated
// board whose serial line is a pseudo-terminal; the same way to both.
// Depends on   host_sim/link.
#pragma once

#include <filesystem>
#include <string>

#include "host_sim/image/identity.hpp"

struct LinkFlash {
    std::string port;    ///< serial: path; empty: the only one there is
    std::string eeprom;  ///< board: file with the content of its EEPROM
    bool dry_run = false;
    bool verify_only = false;
    bool write_all = false;
    bool any_vehicle = false;
    bool stay = false;         ///< leaves the board in the loader
    unsigned patience_s = 30;  ///< waits so long for the loader
};

/// @return  exit code: kExitPass, kExitDifference
/// @errors  SerialError, LoaderError, FlashError, ImageError
int flash_serial(const host_sim::Image& image, const LinkFlash& options);
int flash_board(const host_sim::Image& image, const LinkFlash& options);

/// The one serial port of this PC. @errors  SerialError: none, or several, which are named
[[nodiscard]] std::string only_serial_port(const std::filesystem::path& devices = "/dev");
