#include "protocol/scan/RplidarPackets.h"

#include "protocol/scan/LittleEndian.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

namespace hermes::scan {
namespace {

constexpr double degreesOf64 = 1.0 / 64;
constexpr double usual_ns = 125000; // for each beam
constexpr double slack = 20;        // beams that packets may lie beside each other: it speeds up, beams slant

/// Where the first beam's head stands: ultra dense ones have it behind a stamp and a state.
int startOf(const std::uint8_t *bytes, int form) {
    return word(bytes + (form == 0x86 ? 8 : 2));
}

double startDegrees(const std::uint8_t *bytes, int form) {
    return (form == 0x81 ? word(bytes + 1) >> 1 : startOf(bytes, form) & 0x7FFF) * degreesOf64;
}

struct UltraRange {
    int range_mm, level;
};

/// The distances of form 84 are coarser the longer they are.
UltraRange ultraRange(int code) {
    if (code >= 3328)
        return {16384 + 16 * (code - 3328), 4};
    if (code >= 1792)
        return {4096 + 8 * (code - 1792), 3};
    if (code >= 1280)
        return {2048 + 4 * (code - 1280), 2};
    if (code >= 512)
        return {512 + 2 * (code - 512), 1};
    return {code, 0};
}

/// How far the head is behind the beam: laser and receiver lie beside each other.
double ultraOffset(int range_mm) {
    if (range_mm < 50)
        return 7.5;
    const int m = 98361 / (4 * range_mm);
    return (9150 - 64 * m - double(m) * m * m / 98304) / 65536 * 57.29577951308232;
}

} // namespace

RplidarPackets::RplidarPackets(int baud, RevolutionAssembler &revolutions)
    : byte_ns_(1e10 / baud)
    , revolutions_(revolutions)
    , clock_(usual_ns, slack, 1) {}

std::size_t RplidarPackets::sizeOf(int form) {
    switch (form) {
    case 0x81:
        return 5;
    case 0x82:
    case 0x85:
        return 84;
    case 0x84:
        return 132;
    case 0x86:
        return 170;
    default:
        return 0;
    }
}

int RplidarPackets::beamsOf(int form) {
    return form == 0x82 ? 32 : form == 0x84 ? 96 : form == 0x85 ? 40 : form == 0x86 ? 64 : 1;
}

void RplidarPackets::begin(int form, double sample_us) {
    form_ = form;
    clock_ = SampleClock(sample_us * 1e3, slack, beamsOf(form));
    step_deg_ = 0;
    jump();
}

void RplidarPackets::lose() {
    revolutions_.lose(0);
    hasLast_ = false;
    isGap_ = true;
}

void RplidarPackets::jump() {
    revolutions_.jump();
    clock_.jump();
    hasLast_ = false;
    isGap_ = true;
}

/// Those of form 81 are known by two bits alone, and by heads that go on from one to the next.
bool RplidarPackets::isPacket(const std::uint8_t *bytes) const {
    if (form_ == 0x81) {
        double head_deg = head_deg_;
        for (std::size_t i = 0; i < needed(); i += size()) {
            const std::uint8_t *beam = bytes + i;
            const double before_deg = std::exchange(head_deg, startDegrees(beam, form_));
            const bool isChecked =
                (beam[0] & 1) != (beam[0] >> 1 & 1) && (beam[1] & 1) == 1 && head_deg < 361;
            const bool goesOn = std::fmod(head_deg - before_deg + 363, 360) < 33;
            if (!isChecked || (!goesOn && !(isGap_ && i == 0)))
                return false;
        }
        return true;
    }
    if (bytes[0] >> 4 != 0xA || bytes[1] >> 4 != 0x5)
        return false;
    std::uint8_t sum = 0;
    for (std::size_t i = 2; i < size(); ++i)
        sum ^= bytes[i];
    return sum == ((bytes[0] & 0x0F) | (bytes[1] & 0x0F) << 4) && startDegrees(bytes, form_) < 360;
}

void RplidarPackets::take(const std::uint8_t *bytes, const Arrival &arrival, std::size_t bytesSince) {
    if (form_ != 0x81 && startOf(bytes, form_) & 0x8000) { // a new sequence
        lose();
        clock_.jump();
    }
    const double head_deg = startDegrees(bytes, form_);
    const int count = beamsOf(form_);
    // The SDK's figure: half a beam measured, and one that the device takes to work.
    const double late_ns = double(bytesSince) * byte_ns_ + 1.5 * clock_.sample_ns();
    const SampleClock::Time time =
        clock_.take({head_deg, count, isGap_, arrival.mono_ns - std::int64_t(late_ns)});
    revolutions_.setClockBound(time.bound_ns);
    if (time.slips) {
        revolutions_.slip();
        hasLast_ = false; // its time was another
    }
    if (time.lost > 0) {
        revolutions_.lose(time.lost);
        step_deg_ = isGap_ ? step_deg_ : 0; // it may have been wrong
        hasLast_ = false;
    }
    if (hasLast_) {
        const double now_deg = (std::fmod(head_deg - head_deg_ + 363, 360) - 3) / count;
        step_deg_ += (now_deg - step_deg_) * (step_deg_ > 0 ? std::min(count / 32.0, 1.0) : 1);
    }
    clock_.expect(head_deg + count * step_deg_, step_deg_);
    if (form_ == 0x81)
        revolutions_.addClockwise(std::fmod(head_deg, 360), head_deg, float(word(bytes + 3)) * 0.25e-3F,
                                  bytes[0] & 0xFC, time.stamp_ns);
    else if (hasLast_)
        decode(last_, bytes);
    std::memcpy(last_, bytes, size());
    hasLast_ = true;
    isGap_ = false;
    end_ns_ = time.stamp_ns;
    head_deg_ = head_deg;
}

void RplidarPackets::decode(const std::uint8_t *bytes, const std::uint8_t *following) {
    const double start_deg = head_deg_;
    const double advance_deg = std::fmod(startDegrees(following, form_) - start_deg + 360, 360);
    raw_.clear();
    if (form_ == 0x82) {
        for (int cabin = 0; cabin < 16; ++cabin) {
            const std::uint8_t *at = bytes + 4 + 5 * cabin;
            for (int i = 0; i < 2; ++i) {
                const int range = word(at + 2 * i), low = i == 0 ? at[4] & 0x0F : at[4] >> 4;
                raw_.push_back({(low | (range & 3) << 4) / 8.0, float(range & 0xFFFC) * 0.25e-3F, 0});
            }
        }
    } else if (form_ == 0x85) {
        for (int i = 0; i < beamsOf(form_); ++i)
            raw_.push_back({0, float(word(bytes + 4 + 2 * i)) * 1e-3F, 0});
    } else if (form_ == 0x84) {
        decodeUltra(bytes, following);
    } else {
        decodeUltraDense(bytes);
    }
    const int count = beamsOf(form_);
    for (int k = 0; k < count; ++k) {
        const Raw &raw = raw_[std::size_t(k)];
        const double head_deg = start_deg + k * advance_deg / count;
        revolutions_.addClockwise(std::fmod(head_deg, 360), head_deg - raw.offset_deg, raw.range_m,
                                  raw.intensity,
                                  end_ns_ - std::int64_t((count - 1 - k) * clock_.sample_ns()));
    }
}

/// Each word has one distance, and two more as differences from it and from that of the next word.
void RplidarPackets::decodeUltra(const std::uint8_t *bytes, const std::uint8_t *following) {
    constexpr int words = 32;
    const auto add = [this](int range_mm) {
        raw_.push_back({ultraOffset(range_mm), float(std::max(range_mm, 0)) * 1e-3F, 0});
    };
    for (int i = 0; i < words; ++i) {
        const std::uint32_t packed = longWord(bytes + 4 + 4 * i);
        const std::uint32_t next = longWord(i + 1 < words ? bytes + 8 + 4 * i : following + 4);
        const UltraRange major = ultraRange(int(packed & 0xFFF)), after = ultraRange(int(next & 0xFFF));
        const auto difference = [](std::uint32_t bits) {
            return int(bits << 22) / (1 << 22);
        }; // signed, 10 bits
        const int first = difference(packed >> 12 & 0x3FF), second = difference(packed >> 22);
        const UltraRange base = major.range_mm == 0 && after.range_mm > 0 ? after : major;
        const auto isNone = [](int value) { return value == -512 || value == 511; };
        add(major.range_mm);
        add(isNone(first) || base.range_mm == 0 ? 0 : base.range_mm + first * (1 << base.level));
        add(isNone(second) || after.range_mm == 0 ? 0 : after.range_mm + second * (1 << after.level));
    }
}

void RplidarPackets::decodeUltraDense(const std::uint8_t *bytes) {
    const auto add = [this](std::uint32_t packed) {
        const int scale = packed & 3;
        static constexpr int bits[] = {0x3FF, 0x7FF, 0xFFF, 0x1FFF}, base[] = {0, 2046, 8187, 24567};
        const int range_mm = base[scale] + (scale + 2) * int(packed >> 2 & std::uint32_t(bits[scale]));
        const auto quality = std::uint8_t(packed >> (12 + scale) << scale);
        raw_.push_back({0, float(range_mm) * 1e-3F, quality});
    };
    for (int cabin = 0; cabin < 32; ++cabin) {
        const std::uint8_t *at = bytes + 10 + 5 * cabin;
        add(std::uint32_t(word(at)) | std::uint32_t(at[4] & 0x0F) << 16);
        add(std::uint32_t(word(at + 2)) | std::uint32_t(at[4] >> 4) << 16);
    }
}

} // namespace hermes::scan
