// loader_client.cpp - see loader_client.hpp.
#include "host_sim/bind/loader_client.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

namespace host_sim {
namespace {

using rover::loader::kAnswerBit;
using rover::loader::kPageSize;
using Clock = std::chrono::steady_clock;
using Milliseconds = std::chrono::milliseconds;

constexpr uint8_t kRestartIntoLoader = 2;  // docs/spec/link.md, restart
constexpr std::size_t kHelloSize = 30, kReportSize = 5, kIdentitySize = 20;

std::array<uint8_t, 2> word_bytes(uint16_t word) {
    return {static_cast<uint8_t>(word), static_cast<uint8_t>(word >> 8)};
}

Milliseconds left_until(Clock::time_point end) {
    return std::max(Milliseconds(0), std::chrono::duration_cast<Milliseconds>(end - Clock::now()));
}

std::optional<LoaderHello> parse_hello(const DownlinkFrame& frame) {
    const auto bytes = frame.payload();
    if (bytes.size() != kHelloSize) return {};
    LoaderHello hello;
    hello.protocol_version = bytes[0];
    hello.loader_version = bytes[1];
    hello.application_first = frame.word(2);
    hello.application_end = frame.word(4);
    hello.page_size = bytes[6];
    hello.entry = static_cast<rover::loader::Entry>(bytes[7]);
    hello.is_open = bytes[8] != 0;
    hello.bootable = bytes[9] != 0;
    if (hello.bootable) hello.identity = parse_identity(bytes.subspan(10));
    return hello;
}

}  // namespace

std::string describe(const RemoteIdentity& identity) {
    return fmt::format("rover85 {}.{}.{} sources {:08x} vehicle {}, CRC-16 {:04X}H",
                       identity.version[0], identity.version[1], identity.version[2],
                       identity.source_hash, identity.vehicle, identity.image_crc);
}

std::optional<RemoteIdentity> parse_identity(std::span<const uint8_t> payload) {
    constexpr uint8_t kFormat = 1;
    if (payload.size() != kIdentitySize || payload[0] != kFormat) return {};
    const auto number = [&](std::size_t at, unsigned size) {
        uint32_t value = 0;
        for (unsigned i = 0; i < size; ++i) value |= uint32_t{payload[at + i]} << (8 * i);
        return value;
    };
    RemoteIdentity identity;
    std::copy_n(payload.begin() + 1, 3, identity.version);
    identity.source_hash = number(4, 4);
    identity.image_size = static_cast<uint16_t>(number(8, 2));
    identity.image_crc = static_cast<uint16_t>(number(10, 2));
    for (const uint8_t letter : payload.subspan(12)) {
        if (letter == 0) break;
        identity.vehicle += letter >= ' ' && letter <= '~' ? static_cast<char>(letter) : '?';
    }
    return identity;
}

LoaderClient::LoaderClient(ByteLine line, const Options& options)
    : line_(std::move(line)), options_(options) {}

/// The next frame of a kind; others are dropped.
std::optional<DownlinkFrame> LoaderClient::wait_for(uint8_t kind, Milliseconds timeout) {
    const auto end = Clock::now() + timeout;
    std::array<uint8_t, 1> byte{};  // one at a time: what follows a frame stays for the next call
    do {
        if (line_.read(byte, left_until(end)) == 0) continue;
        auto frame = reader_.take(byte[0], 0);
        if (frame && frame->kind() == kind) return frame;
    } while (Clock::now() < end);
    reader_.reset();
    return {};
}

std::optional<RemoteIdentity> LoaderClient::ask_image(Milliseconds timeout) {
    line_.write(uplink_frame(UplinkType::identity));
    const auto frame = wait_for(DownlinkFrame::kIdentity, timeout);
    if (!frame) return {};
    return parse_identity(frame->payload());
}

std::optional<LoaderHello> LoaderClient::try_hello(Milliseconds timeout) {
    const auto type = static_cast<uint8_t>(Type::hello);
    line_.write(uplink_frame(type));
    const auto frame = wait_for(type | kAnswerBit, timeout);
    return frame ? parse_hello(*frame) : std::nullopt;
}

LoaderHello LoaderClient::reach(Milliseconds timeout, const std::function<void()>& waiting) {
    // A hello frame falls whole into the listening window behind any reset, and an application that
    // listens, 16 bytes each 100 ms, still has room for the restart frame.
    constexpr Milliseconds kBetween{rover::loader::kListenMs - 10};
    constexpr unsigned kRestartEvery = 10, kPatience = 40;
    const auto end = Clock::now() + timeout;
    unsigned tries = 0;
    do {
        if (tries % kRestartEvery == 1) {
            line_.write(uplink_frame(UplinkType::restart, std::array{kRestartIntoLoader}));
        }
        if (const auto hello = try_hello(kBetween)) return *hello;
        if (++tries == kPatience && waiting) waiting();
    } while (Clock::now() < end);
    throw LoaderError(
        "neither the loader nor the image answers; check power, the cable (TxD and RxD crossed) "
        "and the port's name, press RESET on the board and try again; a board without a loader "
        "needs an EPROM programmer (docs/guides/flashing.md)");
}

DownlinkFrame LoaderClient::ask(Type type, std::span<const uint8_t> payload) {
    return ask(type, payload, options_.answer);
}

DownlinkFrame LoaderClient::ask(Type type, std::span<const uint8_t> payload, Milliseconds timeout) {
    const auto number = static_cast<uint8_t>(type);
    for (unsigned attempt = 0; attempt < options_.tries; ++attempt) {
        if (attempt != 0) ++repeated_;
        line_.write(uplink_frame(number, payload));
        if (auto frame = wait_for(number | kAnswerBit, timeout)) return *std::move(frame);
    }
    throw LoaderError(
        "the loader no longer answers; press RESET on the board and run the same "
        "command again: it goes on where it stopped");
}

LoaderReport LoaderClient::ask_report(Type type, std::span<const uint8_t> payload) {
    return report_of(ask(type, payload));
}

LoaderReport LoaderClient::report_of(const DownlinkFrame& frame) {
    const auto bytes = frame.payload();
    if (bytes.size() != kReportSize) {
        throw LoaderError(
            fmt::format("the loader answers with {} bytes instead of {}; is this "
                        "the rover85 of the same version?",
                        bytes.size(), kReportSize));
    }
    return {static_cast<rover::loader::Result>(bytes[0]), frame.word(1), bytes[3], bytes[4]};
}

LoaderHello LoaderClient::hello() {
    const auto hello = parse_hello(ask(Type::hello));
    if (!hello) throw LoaderError("the loader's hello has another form; use its own rover85");
    return *hello;
}

LoaderReport LoaderClient::open() {
    return ask_report(Type::open);
}

LoaderReport LoaderClient::write(uint16_t address, std::span<const uint8_t> page) {
    std::vector<uint8_t> payload;
    payload.reserve(2 + page.size());
    for (const uint8_t byte : word_bytes(address)) payload.push_back(byte);
    payload.insert(payload.end(), page.begin(), page.end());
    return ask_report(Type::write, payload);
}

namespace {

/// The content behind the address. @errors LoaderError: it is not what was asked for
std::span<const uint8_t> content_of(const DownlinkFrame& frame, uint16_t address,
                                    std::size_t size) {
    const auto bytes = frame.payload();
    if (bytes.size() != 2 + size || frame.word(0) != address) {
        throw LoaderError(fmt::format("the loader refuses to read at {:04X}H", address));
    }
    return bytes.subspan(2);
}

}  // namespace

std::vector<uint16_t> LoaderClient::check(uint16_t address, uint8_t count) {
    const auto at = word_bytes(address);
    const DownlinkFrame frame = ask(Type::check, std::array{at[0], at[1], count});
    const auto bytes = content_of(frame, address, 2U * count);
    std::vector<uint16_t> checks;
    for (std::size_t i = 0; i < bytes.size(); i += 2) {
        checks.push_back(static_cast<uint16_t>(bytes[i] | bytes[i + 1] << 8));
    }
    return checks;
}

std::vector<uint8_t> LoaderClient::read(uint16_t address, uint8_t count) {
    const auto at = word_bytes(address);
    const DownlinkFrame frame = ask(Type::read, std::array{at[0], at[1], count});
    const auto bytes = content_of(frame, address, count);
    return {bytes.begin(), bytes.end()};
}

LoaderReport LoaderClient::close(uint16_t identity_at) {
    return report_of(ask(Type::close, word_bytes(identity_at), options_.close));
}

LoaderReport LoaderClient::start() {
    return ask_report(Type::start);
}

}  // namespace host_sim
