// loader_bench.cpp - see loader_bench.hpp.
#include "tests/system/loader/loader_bench.hpp"

#include <algorithm>

#include "firmware/config/eeprom_layout.hpp"

namespace loader_test {
namespace {

using host_sim::Image;
namespace layout = rover::loader;

constexpr uint64_t kSampleT = 997;
constexpr uint16_t kVectorsEnd = hal::rb85::kRst75Vector + 3;

/// A drive, steering or mast motor with power, a laser or a solenoid.
bool anything_has_power(const host_sim::BoardState& state) {
    const auto& motors = state.motors;
    const bool turns = std::ranges::any_of(motors.duties, [](uint8_t duty) { return duty != 0; });
    const auto& ppi = state.ppis[0];
    using Port = host_sim::chips::I82c55a::Port;
    const bool switched = (ppi.port_output(Port::c) & ppi.port_output_mask(Port::c)) != 0;
    return turns || switched;
}

}  // namespace

const Image& built_image() {
    static const Image image = host_sim::load_hex(ROVER_IMAGE);
    return image;
}

Image other_image(const std::string& vehicle) {
    const Image& built = built_image();
    const host_sim::ImageIdentity identity = host_sim::read_identity(built);
    Image other;
    other.file = "other.hex";
    for (std::size_t at = layout::kApplicationFirst; at < identity.image_size; ++at) {
        if (built.present[at]) other.put(static_cast<uint16_t>(at), built.bytes[at]);
    }
    for (std::size_t i = 0; i < host_sim::kVehicleNameSize; ++i) {
        const std::size_t at = identity.address + host_sim::IdentityOffset::vehicle + i;
        other.put(static_cast<uint16_t>(at),
                  static_cast<uint8_t>(i < vehicle.size() ? vehicle[i] : 0));
    }
    const auto stamped = host_sim::stamp_identity(other, {9, 8, 7}, 0x12345678);
    Image loader;
    for (std::size_t at = 0; at <= layout::kLoaderLast; ++at) {
        if (built.present[at]) loader.put(static_cast<uint16_t>(at), built.bytes[at]);
    }
    host_sim::complete_for_board(other, stamped, loader);
    return other;
}

LoaderBench::LoaderBench(bool application) {
    const std::size_t end = application ? hal::rb85::kEepromLast : layout::kLoaderLast;
    live.board().program(std::span(built_image().bytes).first(end + 1));
    for (uint8_t channel = 0; channel < hal::kAdcChannelCount; ++channel) {
        live.board().schedule({.t = 0,
                               .kind = host_sim::Stimulus::Kind::sensor,
                               .index = channel,
                               .value = host_sim::sensor_uv_of_count(2047)});
    }
    watch_motors(kSampleT);
}

void LoaderBench::watch_motors(uint64_t t) {
    live.at(t, [this](host_sim::Board& board) {
        const uint16_t pc = board.state.cpu.pc;
        const bool forwards = pc >= hal::rb85::kTrapVector && pc < kVectorsEnd;  // to the image
        if (!forwards && (pc < layout::kApplicationFirst || pc >= layout::kProgramFirst)) {
            ++samples;
            if (anything_has_power(board.state)) ++powered;
        }
        watch_motors(board.state.cpu.t + kSampleT);
    });
}

host_sim::ByteLine LoaderBench::line() {
    if (!port_) port_ = std::make_shared<host_sim::SerialPort>(live.path());
    host_sim::ByteLine line;
    line.read = [port = port_](std::span<uint8_t> buffer, std::chrono::milliseconds timeout) {
        return port->read(buffer, timeout);
    };
    line.write = [port = port_](std::span<const uint8_t> bytes) {
        port->write(bytes, std::chrono::milliseconds(2000));
    };
    return line;
}

bool LoaderBench::holds(const Image& image) {
    const auto identity = host_sim::read_identity(image);
    const auto pages = host_sim::application_pages(image, identity);
    const auto record = host_sim::boot_record(identity);
    const uint8_t* const content = live.board().state.eeprom.data();
    return std::equal(pages.begin(), pages.end(), content + layout::kApplicationFirst) &&
           std::equal(record.begin(), record.end(), content + layout::kRecordPage);
}

bool LoaderBench::loader_is_untouched() {
    return std::equal(built_image().bytes.begin(),
                      built_image().bytes.begin() + layout::kLoaderLast + 1,
                      live.board().state.eeprom.data());
}

bool LoaderBench::flies(const Image& image) {
    const auto identity = host_sim::read_identity(image);
    auto client = this->client();
    for (int i = 0; i < 40; ++i) {
        const auto remote = client.ask_image(std::chrono::milliseconds(200));
        if (remote) return remote->image_crc == identity.image_crc;
    }
    return false;
}

}  // namespace loader_test
