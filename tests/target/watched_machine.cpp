// watched_machine.cpp - see watched_machine.hpp.
#include "tests/target/watched_machine.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "host_sim/cpu/reference.hpp"

namespace target_test {

namespace {

constexpr uint64_t kLimitT = 20'000'000;
constexpr uint8_t kEnable = 0xFB;
constexpr uint8_t kDisable = 0xF3;

}  // namespace

void WatchedBus::watch(const Device& device, uint16_t address) {
    places_.push_back({device, address});
}

WatchedBus::Byte WatchedBus::find(uint16_t address) const {
    if (!watching_) return {};
    for (const Place& place : places_) {
        for (const Device::Part& part : place.device.parts) {
            const unsigned index = address - place.address - part.offset;
            if (index < part.bytes) return {&place, part, index};
        }
    }
    return {};
}

void WatchedBus::close() {
    if (open_ && open_bytes_ != (1U << open_->bytes) - 1U && violation_.empty()) {
        violation_ = fmt::format("access {}: only a part of {}", accesses_.size(), open_->text());
    }
    if (open_) accesses_.push_back(*open_);
    open_.reset();
    open_bytes_ = 0;
}

void WatchedBus::note(const Access& access) {
    close();
    accesses_.push_back(access);
}

Access& WatchedBus::open(Access::Kind kind, const Byte& byte) {
    const Device& device = byte.place->device;
    const bool belongs = open_ && open_->kind == kind && open_->object == device.name &&
                         open_->offset == byte.part.offset && (open_bytes_ >> byte.index & 1) == 0;
    if (!belongs) {
        close();
        const unsigned bytes = byte.part.bytes;
        open_ =
            Access{.kind = kind, .object = device.name, .offset = byte.part.offset, .bytes = bytes};
        if (kind == Access::Kind::read) {
            open_->value = outside_value(seed_, reads_++) & (~uint64_t{0} >> (64 - 8 * bytes));
        }
    }
    open_bytes_ |= 1U << byte.index;
    return *open_;
}

uint8_t WatchedBus::fetch(uint16_t address, uint64_t) {
    const uint8_t opcode = memory_.bytes[address];
    if (watching_ && opcode == kEnable) note({.kind = Access::Kind::enable});
    if (watching_ && opcode == kDisable) note({.kind = Access::Kind::disable});
    return opcode;
}

uint8_t WatchedBus::read(uint16_t address, uint64_t) {
    const Byte byte = find(address);
    if (byte.place == nullptr) return memory_.bytes[address];
    const Access& access = open(Access::Kind::read, byte);
    const auto value = static_cast<uint8_t>(access.value >> 8 * byte.index);
    if (open_bytes_ == (1U << access.bytes) - 1U) close();
    return value;
}

void WatchedBus::write(uint16_t address, uint8_t value, uint64_t) {
    const Byte byte = find(address);
    if (byte.place == nullptr) {
        memory_.bytes[address] = value;
        return;
    }
    Access& access = open(Access::Kind::write, byte);
    access.value |= static_cast<uint64_t>(value) << 8 * byte.index;
    if (open_bytes_ == (1U << access.bytes) - 1U) close();
}

uint8_t WatchedBus::in(uint8_t port, uint64_t) {
    const auto value = static_cast<uint8_t>(outside_value(seed_, reads_++));
    note({.kind = Access::Kind::in, .object = fmt::format("port {}", port), .value = value});
    return value;
}

void WatchedBus::out(uint8_t port, uint8_t value, uint64_t) {
    note({.kind = Access::Kind::out, .object = fmt::format("port {}", port), .value = value});
}

WatchedRun run_watched(const toolchain::assembly::Program& program,
                       const std::vector<Device>& devices, uint64_t seed, bool undocumented) {
    host_sim::FlatMemory memory = host_sim::all_ram();
    memory.bytes.fill(0xA7);
    for (std::size_t i = 0; i < toolchain::assembly::kMemorySize; ++i) {
        if (program.image.present[i]) memory.bytes[i] = program.image.bytes[i];
    }
    WatchedBus bus(memory, seed);
    for (const Device& device : devices) {
        const toolchain::assembly::Symbol* symbol = program.find(device.name);
        if (symbol == nullptr && device.address == 0) {
            throw std::runtime_error(device.name + " is not in the program");
        }
        bus.watch(device, symbol == nullptr ? device.address : symbol->value);
    }
    const toolchain::assembly::Symbol* main = program.find("main");
    if (main == nullptr) throw std::runtime_error("the program has no main");
    host_sim::CpuState cpu;
    cpu.pc = program.start.value_or(0);
    host_sim::Reference<WatchedBus> processor(
        cpu, bus,
        undocumented ? host_sim::InstructionSet::all : host_sim::InstructionSet::documented);
    while (!cpu.halted && cpu.t < kLimitT) {
        if (cpu.pc == main->value) bus.start();
        if (!processor.execute()) {
            throw std::runtime_error(fmt::format("no instruction at {:04X}H", cpu.pc));
        }
    }
    bus.finish();
    return {.accesses = bus.accesses(), .violation = bus.violation(), .halted = cpu.halted};
}

}  // namespace target_test
