// image_bench.cpp - see image_bench.hpp.
#include "tests/system/image/image_bench.hpp"

#include <algorithm>
#include <cstring>
#include <stdexcept>

namespace image_test {

namespace {

using host_sim::Stimulus;

// docs/spec/memory-map.md
constexpr std::ptrdiff_t kApplicationFirst = 0x0C00;
constexpr std::size_t kRecordPage = 0x7FC0;

Program load() {
    const std::string image = ROVER_IMAGE;
    const host_sim::Image hex = host_sim::load_hex(image);
    Program loaded;
    const auto extent = hex.extent();
    if (!extent) throw std::runtime_error(image + " is empty");
    loaded.rom.assign(hex.bytes.begin(), hex.bytes.begin() + extent->last + 1);
    std::string symbols = image;
    symbols.replace(symbols.size() - 4, 4, ".sym");
    loaded.symbols = host_sim::load_symbols(symbols);
    const host_sim::Symbol* identity = loaded.symbols.find("rover_identity");
    if (identity == nullptr) throw std::runtime_error("no rover_identity in " + symbols);
    loaded.identity = identity->address;
    uint8_t* block = &loaded.rom[loaded.identity];
    std::size_t end = kRecordPage;
    while (!hex.present[end - 1]) --end;
    loaded.image_end = end;
    block[16] = static_cast<uint8_t>(end & 0xFF);
    block[17] = static_cast<uint8_t>(end >> 8);
    block[18] = block[19] = 0;
    const uint16_t crc = crc_of({loaded.rom.begin() + kApplicationFirst,
                                 loaded.rom.begin() + static_cast<std::ptrdiff_t>(end)});
    block[18] = static_cast<uint8_t>(crc & 0xFF);
    block[19] = static_cast<uint8_t>(crc >> 8);
    return loaded;
}

}  // namespace

const Program& program() {
    static const Program loaded = load();
    return loaded;
}

uint16_t crc_of(const std::vector<uint8_t>& bytes) {
    unsigned crc = 0xFFFF;
    for (const uint8_t byte : bytes) {
        for (int bit = 7; bit >= 0; --bit) {
            const bool one = ((crc >> 15) ^ (byte >> bit & 1U)) != 0;
            crc = (crc << 1 & 0xFFFFU) ^ (one ? 0x1021U : 0U);
        }
    }
    return static_cast<uint16_t>(crc);
}

ImageBench::ImageBench()
    : tick_count_(address("rover_tick_count")), step_count_(address("rover_step_count")) {
    board.program(program().rom);
    for (uint8_t channel = 0; channel < hal::kAdcChannelCount; ++channel) sensor(channel, 2047);
    board.state.cpu.t = 0;
}

uint16_t ImageBench::address(const std::string& symbol) const {
    const host_sim::Symbol* found = program().symbols.find(symbol);
    if (found != nullptr) return found->address;
    // Names of the image's own are in two namespaces, those of functions end in parameters.
    for (const host_sim::Symbol& each : program().symbols.all()) {
        const std::string name = "::" + each.name;
        if (name.ends_with("::" + symbol) || name.find("::" + symbol + "(") != std::string::npos) {
            return each.address;
        }
    }
    throw std::out_of_range(symbol);
}

uint16_t ImageBench::word(uint16_t address) const {
    return static_cast<uint16_t>(byte(address) | byte(static_cast<uint16_t>(address + 1)) << 8);
}

bool ImageBench::run_to_step(uint16_t count) {
    const uint64_t limit = now() + 10 * kSecondT + count * kStepT;
    // Behind a reset the loader listens, and the counter is that of the run before until the image
    // has cleared it.
    const uint16_t pc = board.state.cpu.pc;
    const bool forwards = pc >= 0x24 && pc < 0x3F;  // an interrupt on its way to the image
    if (pc < kApplicationFirst && !forwards && !run_to("rover_boot")) return false;
    // The RAM test makes other values of the counter for a moment: it has to be seen twice.
    for (uint16_t before = 0; now() < limit; run(2000)) {
        const uint16_t seen = steps();
        if (seen == before && seen != 0 && static_cast<int16_t>(seen - count) >= 0) return true;
        before = seen;
    }
    return false;
}

void ImageBench::reset() {
    board.reset();
    run(100'000);
}

bool ImageBench::run_to(const std::string& symbol) {
    const uint16_t place = address(symbol);
    const uint64_t limit = now() + 10 * kSecondT;
    host_sim::StepRecord record;
    while (now() < limit) {
        if (board.state.cpu.pc == place) return true;
        board.step(record, limit);
    }
    return false;
}

void ImageBench::send(const std::vector<uint8_t>& bytes) {
    uint64_t at = now();
    for (const uint8_t byte : bytes) {
        board.schedule({.t = at, .kind = Stimulus::Kind::serial_byte, .value = byte});
        at += kCharacterT;
    }
}

void ImageBench::send_frame(uint8_t type, const std::vector<uint8_t>& payload) {
    std::vector<uint8_t> checked = {type, static_cast<uint8_t>(payload.size())};
    for (const uint8_t byte : payload) checked.push_back(byte);
    const uint16_t crc = crc_of(checked);
    std::vector<uint8_t> bytes = {0xC5, 0x3A};
    for (const uint8_t byte : checked) bytes.push_back(byte);
    bytes.push_back(static_cast<uint8_t>(crc & 0xFF));
    bytes.push_back(static_cast<uint8_t>(crc >> 8));
    send(bytes);
}

std::vector<Frame> ImageBench::frames() {
    for (const auto& sent : board.take_transmitted()) stream_.push_back(sent.byte);
    std::vector<Frame> found;
    std::size_t at = 0;
    while (stream_.size() - at >= 6) {
        if (stream_[at] != 0xA5 || stream_[at + 1] != 0x5A) {
            ++at;
            ++stray_bytes_;
            continue;
        }
        const std::size_t size = stream_[at + 3];
        if (stream_.size() - at < size + 6) break;
        const auto begin = stream_.begin() + static_cast<std::ptrdiff_t>(at);
        const auto length = static_cast<std::ptrdiff_t>(size);
        Frame frame;
        frame.kind = stream_[at + 2];
        frame.payload.assign(begin + 4, begin + 4 + length);
        frame.bytes.assign(begin, begin + 6 + length);
        const uint16_t crc = crc_of({begin + 2, begin + 4 + length});
        const bool good =
            frame.bytes[size + 4] == (crc & 0xFF) && frame.bytes[size + 5] == crc >> 8;
        if (good) found.push_back(frame);
        stray_bytes_ += good ? 0 : size + 6;
        at += size + 6;
    }
    stream_.erase(stream_.begin(), stream_.begin() + static_cast<std::ptrdiff_t>(at));
    return found;
}

std::optional<Frame> ImageBench::ask(uint8_t type, const std::vector<uint8_t>& payload,
                                     uint8_t kind) {
    send_frame(type, payload);
    const uint64_t limit = now() + 5 * kStepT;
    while (now() < limit) {
        run(kCharacterT);
        for (const Frame& frame : frames()) {
            if (frame.kind == kind) return frame;
        }
    }
    return std::nullopt;
}

std::optional<rover::BoardStatus> ImageBench::ask_status() {
    const auto frame = ask(0x02, {}, 0x81);
    if (!frame || frame->payload.size() != sizeof(rover::BoardStatus)) return std::nullopt;
    rover::BoardStatus status;
    std::memcpy(&status, frame->payload.data(), sizeof status);
    return status;
}

std::optional<ImageBench::Checkpoint> ImageBench::slot(uint16_t address) const {
    if (byte(address) != 0xA5) return std::nullopt;
    std::vector<uint8_t> checked;
    for (uint16_t i = 1; i <= 25; ++i) checked.push_back(byte(static_cast<uint16_t>(address + i)));
    if (word(static_cast<uint16_t>(address + 26)) != crc_of(checked)) return std::nullopt;
    Checkpoint read;
    read.sequence = checked[0];
    std::memcpy(&read.record, &checked[1], sizeof read.record);
    return read;
}

std::optional<ImageBench::Checkpoint> ImageBench::checkpoint() const {
    const auto a = slot(0xFF20);
    const auto b = slot(0xFF40);
    if (!a) return b;
    if (!b) return a;
    return static_cast<int8_t>(a->sequence - b->sequence) > 0 ? a : b;
}

void ImageBench::sensor(uint8_t channel, uint16_t count) {
    board.schedule({.t = now(),
                    .kind = Stimulus::Kind::sensor,
                    .index = channel,
                    .value = host_sim::sensor_uv_of_count(count)});
}

void ImageBench::drive(unsigned pulses, uint64_t t) {
    for (unsigned i = 0; i < pulses; ++i) {
        for (uint8_t wheel = 0; wheel < hal::kWheelCount; ++wheel) {
            board.schedule({.t = now() + (i * t + t / 2) / pulses + wheel,
                            .kind = Stimulus::Kind::tach_pulse,
                            .index = wheel});
        }
    }
}

}  // namespace image_test
