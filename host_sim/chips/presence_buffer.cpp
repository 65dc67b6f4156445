// presence_buffer.cpp - presence of the tachometers.
#include "host_sim/chips/presence_buffer.hpp"

#include <fmt/format.h>

namespace host_sim::chips {

void PresenceBuffer::set_connected(unsigned wheel, bool plugged) {
    const unsigned bit = 1u << wheel;
    lines = static_cast<uint8_t>(plugged ? lines | bit : lines & ~bit);
}

Properties PresenceBuffer::properties() const {
    return {{"tachometers of wheels 5 to 0", fmt::format("{:06b}b", lines & 0x3F)}};
}

}  // namespace host_sim::chips
