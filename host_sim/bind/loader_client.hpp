// loader_client.hpp - the PC's side of the loader's protocol: a request, its answer, again if none.
// Depends on   host_sim/bind/link_frames.hpp, firmware/loader/protocol.hpp (numbers only).
// Normative    docs/spec/loader.md
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "firmware/loader/protocol.hpp"
#include "host_sim/bind/link_frames.hpp"

namespace host_sim {

/// A two-way line of bytes, as SerialPort is.
struct ByteLine {
    using Milliseconds = std::chrono::milliseconds;
    /// Waits for bytes. @return  how many came; 0: none within `timeout`
    std::function<std::size_t(std::span<uint8_t> buffer, Milliseconds timeout)> read;
    /// Sends bytes.
    std::function<void(std::span<const uint8_t> bytes)> write;
};

/// The board does not answer, or not as the protocol says. The text is complete.
class LoaderError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// What the image in the board says of itself: the identity frame's content.
struct RemoteIdentity {
    uint8_t version[3] = {};
    uint32_t source_hash = 0;
    uint16_t image_size = 0;
    uint16_t image_crc = 0;
    std::string vehicle;

    bool operator==(const RemoteIdentity&) const = default;
};
/// "rover85 0.1.0 sources 1a2b3c4d vehicle Rocky3.2, CRC-16 4E6EH"
[[nodiscard]] std::string describe(const RemoteIdentity& identity);
/// @return  nothing if it is none
[[nodiscard]] std::optional<RemoteIdentity> parse_identity(std::span<const uint8_t> payload);

struct LoaderHello {
    uint8_t protocol_version = 0;
    uint8_t loader_version = 0;
    uint16_t application_first = 0;
    uint16_t application_end = 0;
    uint8_t page_size = 0;
    rover::loader::Entry entry{};
    bool is_open = false;
    bool bootable = false;
    std::optional<RemoteIdentity> identity;  ///< of a bootable image
};

struct LoaderReport {
    rover::loader::Result result{};
    uint16_t address = 0;
    uint8_t expected = 0, found = 0;
};

class LoaderClient {
public:
    using Milliseconds = std::chrono::milliseconds;
    struct Options {
        Milliseconds answer{1500};  ///< for one answer
        unsigned tries = 3;         ///< of each request
        Milliseconds close{6000};   ///< for that of close, which looks at the whole image
    };
    explicit LoaderClient(ByteLine line) : LoaderClient(std::move(line), Options{}) {}
    LoaderClient(ByteLine line, const Options& options);

    /// Is it the image that answers? Asks it which it is; nothing within `timeout`: it does not.
    [[nodiscard]] std::optional<RemoteIdentity> ask_image(Milliseconds timeout);

    /// Gets the board into the loader: offers hello frames, which a loader answers and the start of
    /// a board that is being reset hears, and tells an image that listens to go there.
    /// @param waiting  called once when nobody has answered for 2 s: somebody has to press RESET
    /// @errors  LoaderError: nobody within `timeout`
    LoaderHello reach(Milliseconds timeout, const std::function<void()>& waiting = {});

    // -- Requests. @errors LoaderError: no answer
    // --------------------------------------------------
    LoaderHello hello();
    LoaderReport open();
    LoaderReport write(uint16_t address, std::span<const uint8_t> page);
    /// CRC-16 of pages. @param count  up to kChecksMax
    std::vector<uint16_t> check(uint16_t address, uint8_t count);
    std::vector<uint8_t> read(uint16_t address, uint8_t count);
    LoaderReport close(uint16_t identity_at);
    LoaderReport start();

    /// Requests that were sent again.
    [[nodiscard]] unsigned repeated() const { return repeated_; }

private:
    using Type = rover::loader::Request;
    [[nodiscard]] std::optional<DownlinkFrame> wait_for(uint8_t kind, Milliseconds timeout);
    DownlinkFrame ask(Type type, std::span<const uint8_t> payload = {});
    DownlinkFrame ask(Type type, std::span<const uint8_t> payload, Milliseconds timeout);
    LoaderReport ask_report(Type type, std::span<const uint8_t> payload = {});
    static LoaderReport report_of(const DownlinkFrame& frame);
    std::optional<LoaderHello> try_hello(Milliseconds timeout);

    ByteLine line_;
    Options options_;
    DownlinkReader reader_;
    unsigned repeated_ = 0;
};

}  // namespace host_sim
