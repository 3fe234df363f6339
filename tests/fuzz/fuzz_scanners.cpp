#include "tests/fuzz/FuzzInput.h"

#include "protocol/scan/ScannerModel.h"

#include <sanitizer/allocator_interface.h>

using namespace hermes::scan;

namespace {

constexpr std::int64_t epoch_ns = 1700000000000000000;
constexpr std::int64_t longest_ns = 200000000000; // of a sweep that a scanner may tell
constexpr std::int64_t parted_ns = 1000000000;    // clocks that part by more are joined anew
constexpr std::size_t mostMemory = 32 << 20;      // for the longest revolution and its bytes
constexpr std::size_t mostFed = 1 << 18;

bool isOf(const ScannerModel &model, std::string_view family) {
    return std::string_view(model.name).substr(0, family.size()) == family;
}

/// A scanner, and what has to hold of all that comes out of it.
struct Reader {
    explicit Reader(const ScannerModel &model)
        : scanner(model.make(model, revolutions))
        , isSpinning(!isOf(model, "hokuyo") && !isOf(model, "sick")) {}

    void take(const Revolution &revolution) {
        FUZZ_REQUIRE(isSpinning ? revolution.number == number : revolution.number >= number);
        number = revolution.number + 1;
        FUZZ_REQUIRE(revolution.lostPackets < 1000000000 && !revolution.beams.empty());
        FUZZ_REQUIRE(revolution.begin_ns > epoch_ns - longest_ns && revolution.clockBound_ns >= 0);
        FUZZ_REQUIRE(revolution.end_ns <= now_ns + (isSpinning ? parted_ns : longest_ns));
        double angle_deg = -1e9;
        for (const Beam &beam : revolution.beams) {
            FUZZ_REQUIRE(std::isfinite(beam.range_m) && beam.range_m >= 0);
            FUZZ_REQUIRE(std::isfinite(beam.angle_deg) && std::abs(beam.angle_deg) < 1000);
            FUZZ_REQUIRE(beam.stamp_ns >= revolution.begin_ns && beam.stamp_ns <= revolution.end_ns);
            FUZZ_REQUIRE(!isSpinning || beam.angle_deg >= angle_deg);
            angle_deg = beam.angle_deg;
        }
    }

    RevolutionAssembler revolutions{[this](const Revolution &revolution) { take(revolution); }};
    std::unique_ptr<ScannerProtocol> scanner;
    const bool isSpinning;
    std::uint64_t number = 0;
    std::int64_t now_ns = epoch_ns;
};

void append(std::string &text, int value) {
    text += char(value);
    text += char(value >> 8);
}

/// An answer of an RPLIDAR or a YDLIDAR that makes packets come, or tells what the host asks.
std::string answer(FuzzInput &in) {
    constexpr struct {
        std::uint8_t type, size;
    } kinds[] = {{0x81, 5}, {0x82, 84}, {0x84, 132}, {0x85, 84}, {0x86, 170}, {0x04, 20},
                 {0x04, 4}, {0x06, 3},  {0x15, 4},   {0xFF, 4},  {0x20, 6},   {0x20, 8}};
    const std::size_t kind = in.take<std::uint8_t>() % std::size(kinds);
    const bool isStream = kind < 5;
    std::string text{
        '\xA5', '\x5A', char(kinds[kind].size), 0, 0, char(isStream ? 0x40 : 0), char(kinds[kind].type)};
    if (!isStream) {
        text += in.bytes(kinds[kind].size);
        text.resize(7 + kinds[kind].size);
    }
    return text;
}

/// A capsule of an RPLIDAR whose checksum is right.
std::string capsule(FuzzInput &in) {
    constexpr std::size_t sizes[] = {84, 132, 170};
    std::string body = in.bytes(sizes[in.take<std::uint8_t>() % 3] - 2);
    body.resize(sizes[body.size() > 130 ? 2 : body.size() > 82 ? 1 : 0] - 2);
    char sum = 0;
    for (const char byte : body)
        sum = char(sum ^ byte);
    return std::string{char(0xA0 | (sum & 15)), char(0x50 | (sum >> 4 & 15))} + body;
}

std::string ldrobotPacket(FuzzInput &in) {
    std::string text = "\x54\x2C" + in.bytes(44);
    text.resize(46);
    int crc = 0;
    for (const char byte : text) {
        crc ^= std::uint8_t(byte);
        for (int bit = 0; bit < 8; ++bit)
            crc = crc & 0x80 ? (crc << 1 ^ 0x4D) & 0xFF : crc << 1;
    }
    return text + char(crc);
}

std::string ydlidarPacket(FuzzInput &in, bool hasIntensity) {
    const int count = 1 + in.take<std::uint8_t>() % 80;
    std::string head = "\xAA\x55" + std::string{char(in.take<std::uint8_t>()), char(count)};
    for (int i = 0; i < 2; ++i)
        append(head, in.take<std::uint16_t>() | 1);
    int sum = 0;
    for (std::size_t i = 0; i < head.size(); i += 2)
        sum ^= std::uint8_t(head[i]) | std::uint8_t(head[i + 1]) << 8;
    std::string beams;
    for (int i = 0; i < count; ++i) {
        const int intensity = hasIntensity ? in.take<std::uint8_t>() : 0, range = in.take<std::uint16_t>();
        if (hasIntensity)
            beams += char(intensity);
        append(beams, range);
        sum ^= range ^ intensity;
    }
    append(head, sum);
    return head + beams;
}

/// Lines of a Hokuyo, each with its sum; `;` before it where the input says so.
std::string hokuyoBlock(FuzzInput &in) {
    constexpr const char *echoes[] = {"PP", "VV", "BM", "QT", "MD0044072501000", "MD0000000001000"};
    std::string text = std::string(echoes[in.take<std::uint8_t>() % std::size(echoes)]) + "\n";
    const auto add = [&text](std::string line, bool hasSemicolon) {
        unsigned sum = 0;
        for (const char character : line)
            sum += std::uint8_t(character);
        text += line + (hasSemicolon ? ";" : "") + char((sum & 0x3F) + 0x30) + "\n";
    };
    add(in.flag() ? "99" : "00", false);
    if (in.flag()) // what PP tells
        for (const char *const name : {"ARES:", "AMIN:", "AMAX:", "AFRT:", "SCAN:"})
            add(name + std::to_string(in.take<std::uint16_t>()), true);
    for (auto lines = in.take<std::uint8_t>() % 40; lines > 0 && in.left() > 0; --lines) {
        std::string line = in.bytes(in.take<std::uint8_t>() % 65);
        for (char &character : line)
            character = char(0x30 + (character & 0x3F));
        add(line, in.take<std::uint8_t>() % 8 == 0);
    }
    return text + "\n";
}

std::string sickTelegram(FuzzInput &in) {
    std::string text = "\x02sSN LMDscandata";
    for (auto words = in.take<std::uint8_t>(); words > 0 && in.left() > 0; --words) {
        const auto kind = in.take<std::uint8_t>();
        constexpr const char *usual[] = {" 0", " 1", " DIST1", " RSSI1", " 3F800000", " 5DC", " FFF92230"};
        char word[12];
        std::snprintf(word, sizeof word, " %X",
                      kind % 16 == 0 ? unsigned(in.take<std::uint32_t>())
                                     : unsigned(in.take<std::uint8_t>()));
        text += kind % 16 < 8 ? word : usual[kind % std::size(usual)];
    }
    return text + "\x03";
}

std::string packet(const ScannerModel &model, FuzzInput &in) {
    if (isOf(model, "hokuyo"))
        return hokuyoBlock(in);
    if (isOf(model, "sick"))
        return sickTelegram(in);
    if (isOf(model, "ydlidar"))
        return in.take<std::uint8_t>() % 8 == 0 ? answer(in)
                                                : ydlidarPacket(in, isOf(model, "ydlidar-tmini"));
    if (isOf(model, "rplidar"))
        return in.take<std::uint8_t>() % 8 == 0 ? answer(in) : capsule(in);
    return ldrobotPacket(in);
}

} // namespace

/// Whatever a line delivers, in whatever pieces: beams are finite, nothing grows without end, and the pieces
/// make no difference to what is counted.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    FuzzInput in(data, size);
    const ScannerModel &model = scannerModels()[in.take<std::uint8_t>() % scannerModels().size()];
    Reader whole(model), pieces(model);
    const std::size_t before = __sanitizer_get_current_allocated_bytes();
    std::int64_t now_ns = 0;
    std::size_t fed = 0;
    const auto both = [&](const auto &act) {
        for (Reader *const reader : {&whole, &pieces})
            act(*reader->scanner);
    };
    const auto feed = [&](const std::string &bytes) {
        fed += bytes.size();
        const Arrival arrival{epoch_ns + now_ns, now_ns};
        whole.scanner->feed(bytes, arrival);
        for (std::size_t at = 0, next = 0; at < bytes.size(); at = next) {
            next = at + 1 + (in.left() > 0 ? in.take<std::uint8_t>() : 255);
            pieces.scanner->feed(std::string_view(bytes).substr(at, next - at), arrival);
        }
        FUZZ_REQUIRE(__sanitizer_get_current_allocated_bytes() < before + mostMemory);
    };
    while (in.left() > 0 && fed < mostFed) {
        const auto kind = in.take<std::uint8_t>();
        now_ns += kind % 64 == 0 ? in.take<std::uint8_t>() * std::int64_t(100000000) : kind * 100000;
        whole.now_ns = pieces.now_ns = epoch_ns + now_ns;
        if (kind % 16 < 8) {
            feed(packet(model, in));
        } else if (kind % 16 < 11) {
            feed(in.bytes(in.take<std::uint8_t>()));
        } else if (kind % 16 == 11) {
            const std::string text =
                kind < 128 ? packet(model, in) : in.bytes(1 + in.take<std::uint8_t>() % 32);
            std::string many;
            for (int count = 64 * in.take<std::uint8_t>(); count > 0 && many.size() < mostFed / 2; --count)
                many += text;
            feed(many);
        } else if (kind % 16 == 12) {
            const std::string text = in.bytes(in.take<std::uint8_t>() % 64);
            both([&](ScannerProtocol &scanner) { scanner.prepare(text); });
            const std::string told = whole.scanner->prerequisite();
            both([&](ScannerProtocol &scanner) { scanner.prepare(told); });
            FUZZ_REQUIRE(whole.scanner->prerequisite() == told);
        } else if (kind % 16 == 13) {
            both([&](ScannerProtocol &scanner) { kind < 128 ? scanner.jump() : scanner.opened(now_ns); });
        } else {
            both([&](ScannerProtocol &scanner) { (void)scanner.next(now_ns); });
        }
    }
    const ScannerProtocol::Counts &one = whole.scanner->counts(), &other = pieces.scanner->counts();
    FUZZ_REQUIRE(one.packets == other.packets && one.damaged == other.damaged);
    FUZZ_REQUIRE(one.skippedBytes == other.skippedBytes && one.skippedBytes <= fed);
    FUZZ_REQUIRE(whole.scanner->identity().model.size() < 20000);
    for (Reader *const reader : {&whole, &pieces})
        reader->revolutions.jump();
    return 0;
}
