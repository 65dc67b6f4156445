// avr_run.cpp - runs an image for an ATmega2560 in simavr until its byte `rover_done` is not 0, and
// prints `rover_checksum`.
// Usage        avr_run IMAGE.elf CYCLES
// Exit         0: "checksum 1A2B3C4D"; 3: not done within CYCLES; 4: the processor stopped; 1:
// usage Depends on   libsimavr, in a program of its own because that library ends the process on
// errors.
#include <simavr/sim_avr.h>
#include <simavr/sim_elf.h>

#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string_view>

namespace {

constexpr uint32_t kDataSpace = 0x800000;  // the linker's name for address 0 of RAM
constexpr uint16_t kAllRam = 0xFFFF;       // more RAM than the part has, so that programs fit

void say_nothing(avr_t*, int, const char*, std::va_list) {}

uint32_t address_of(const elf_firmware_t& image, std::string_view name) {
    for (uint32_t i = 0; i < image.symbolcount; ++i) {
        if (name == image.symbol[i]->symbol) return image.symbol[i]->addr - kDataSpace;
    }
    std::fprintf(stderr, "avr_run: no symbol %.*s\n", static_cast<int>(name.size()), name.data());
    std::exit(1);
}

int run(char** argv) {
    const uint64_t cycles = std::strtoull(argv[2], nullptr, 10);
    avr_global_logger_set(say_nothing);
    elf_firmware_t image{};
    if (elf_read_firmware(argv[1], &image) != 0) {
        std::fprintf(stderr, "avr_run: cannot read %s\n", argv[1]);
        return 1;
    }
    avr_t* avr = avr_make_mcu_by_name("atmega2560");
    avr->ramend = kAllRam;
    avr_init(avr);
    avr_load_firmware(avr, &image);
    avr->frequency = 16'000'000;
    const uint32_t done = address_of(image, "rover_done");
    const uint32_t checksum = address_of(image, "rover_checksum");
    while (avr->data[done] == 0) {
        if (avr->cycle >= cycles) return 3;
        const int state = avr_run(avr);
        if (state == cpu_Done || state == cpu_Crashed) return 4;
    }
    std::printf("checksum %02X%02X%02X%02X\n", avr->data[checksum + 3], avr->data[checksum + 2],
                avr->data[checksum + 1], avr->data[checksum]);
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 3) {
        std::fprintf(stderr, "usage: avr_run IMAGE.elf CYCLES\n");
        return 1;
    }
    const int status = run(argv);
    std::fflush(stdout);
    std::_Exit(status);  // the library frees nothing: a leak checker would end this with an error
}
