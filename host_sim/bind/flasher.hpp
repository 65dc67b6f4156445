// flasher.hpp - brings an image into a board through its loader: only pages that differ, verified,
// bootable at the end; goes on by itself behind a reset of the board.
// Depends on   host_sim/bind/loader_client.hpp, host_sim/image/board_image.hpp.
// Design note  docs/design/loader.md
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "host_sim/bind/loader_client.hpp"
#include "host_sim/image/board_image.hpp"

namespace host_sim {

struct FlashProgress {
    const char* what = "";  ///< "compare", "write", "verify"
    std::size_t done = 0, all = 0;
};

struct FlashOptions {
    bool keep_other_vehicles = true;  ///< refuses an image of another vehicle than the board's
    bool write_all = false;           ///< also pages that are right already
    unsigned rounds = 8;              ///< so often it begins anew when the board was reset
    std::function<void(const FlashProgress&)> progress{};
    /// Told when the loader was lost and is being looked for. @return false: give up
    std::function<bool()> lost{};
};

struct FlashResult {
    std::optional<RemoteIdentity> before;
    std::optional<RemoteIdentity> after;
    std::size_t pages = 0;  ///< of the image
    std::size_t pages_written = 0;
    unsigned resumed = 0;               ///< rounds behind the first
    bool was_bootable_already = false;  ///< nothing had to be done
};

/// The image could not be brought in; the text says where, what and why it may be. The board is
/// not bootable, and its loader answers.
class FlashError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// @param client  has reached the loader
/// @errors  FlashError, LoaderError
FlashResult flash_over_link(LoaderClient& client, const Image& image, const FlashOptions& options);

/// How bytes of the board differ from the image's, with a guess at the cause.
struct VerifyReport {
    uint16_t first = 0;  ///< address
    uint8_t expected = 0, found = 0;
    std::size_t count = 0;
    std::size_t pages = 0;
    std::string likely_cause;
};
/// What a wrong byte and its neighbours tell.
[[nodiscard]] std::string likely_cause(std::span<const uint8_t> expected,
                                       std::span<const uint8_t> found);
/// Compares the image with the board's EEPROM. @return  nothing: all the same
[[nodiscard]] std::optional<VerifyReport> verify_over_link(
    LoaderClient& client, const Image& image,
    const std::function<void(const FlashProgress&)>& progress = {});

}  // namespace host_sim
