#pragma once

#include <QByteArray>
#include <QList>

#include <cmath>
#include <cstdint>
#include <map>
#include <vector>

/// What a scanner's bytes say, read by the published formats alone.
struct ReadPoint {
    double angle = 0; ///< degrees, as the scanner counts them, 0 to 360
    double range = 0; ///< metres; 0: none
    int intensity = 0;
    bool first = false; ///< of a turn, where the packets say so
};

struct Reading {
    std::vector<ReadPoint> points;
    int packets = 0;
    int strayBytes = 0;          ///< of no packet
    std::vector<int> packetEnds; ///< position behind each packet
    std::vector<double> stamps;  ///< seconds, of scanners with a clock
};

inline unsigned u8(const QByteArray &b, int at) {
    return std::uint8_t(b[at]);
}
inline unsigned u16(const QByteArray &b, int at) {
    return u8(b, at) | u8(b, at + 1) << 8;
}
inline std::uint32_t u32(const QByteArray &b, int at) {
    return u16(b, at) | std::uint32_t(u16(b, at + 2)) << 16;
}
inline double circle(double degrees) {
    return std::fmod(std::fmod(degrees, 360) + 360, 360);
}

/// Cuts a stream into packets: size tells how long one is that begins here, 0 when none does or a check
/// fails; -1 when more is needed.
template <typename Size, typename Take>
void cutPackets(const QByteArray &bytes, Reading &reading, const Size &size, const Take &take) {
    int at = 0;
    while (at < bytes.size()) {
        const int length = size(bytes.mid(at, 512));
        if (length < 0)
            return;
        if (length == 0) {
            ++reading.strayBytes;
            ++at;
            continue;
        }
        take(bytes.mid(at, length));
        ++reading.packets;
        at += length;
        reading.packetEnds.push_back(at);
    }
}

inline Reading readRplidar81(const QByteArray &bytes) {
    Reading reading;
    cutPackets(
        bytes, reading,
        [](const QByteArray &b) {
            if (b.size() < 5)
                return -1;
            const bool begins = b[0] & 1, not_ = b[0] & 2;
            return begins != not_ && (b[1] & 1) ? 5 : 0;
        },
        [&](const QByteArray &b) {
            reading.points.push_back(
                {(u16(b, 1) >> 1) / 64.0, u16(b, 3) / 4000.0, int(u8(b, 0) >> 2), bool(b[0] & 1)});
        });
    return reading;
}

/// The points of a packet, with angles before the head's angle.
inline std::vector<ReadPoint> pointsOfRplidar(unsigned type, const QByteArray &b, const QByteArray &next) {
    std::vector<ReadPoint> points;
    if (type == 0x82) {
        for (int cabin = 0; cabin < 16; ++cabin) {
            const unsigned d1 = u16(b, 4 + 5 * cabin), d2 = u16(b, 6 + 5 * cabin), o = u8(b, 8 + 5 * cabin);
            points.push_back({-double((o & 15) | (d1 & 3) << 4) / 8, (d1 & 0xFFFC) / 4000.0});
            points.push_back({-double(o >> 4 | (d2 & 3) << 4) / 8, (d2 & 0xFFFC) / 4000.0});
        }
    } else if (type == 0x84) {
        const auto major = [](unsigned v, int &level) {
            static const unsigned from[] = {0, 512, 1280, 1792, 3328}, mm[] = {0, 512, 2048, 4096, 16384};
            level = 4;
            while (level > 0 && v < from[level])
                --level;
            return int(mm[level] + ((v - from[level]) << level));
        };
        const auto add = [&](int mm) {
            double before = 7.5;
            if (mm >= 50) {
                const int m = 98361 / (4 * mm);
                before = (9150 - 64.0 * m - double(m) * m * m / 98304) / 65536 * 180 / M_PI;
            }
            points.push_back({-before, mm / 1000.0});
        };
        for (int word = 0; word < 32; ++word) {
            const std::uint32_t w = u32(b, 4 + 4 * word);
            const std::uint32_t after = word < 31 ? u32(b, 8 + 4 * word) : u32(next, 4);
            int level = 0, nextLevel = 0;
            const int v0 = major(w & 0xFFF, level), v1 = major(after & 0xFFF, nextLevel);
            const int p1 = int(w << 10) >> 22, p2 = int(w) >> 22;
            const auto predicted = [](int p, int from, int shift) {
                return p == -512 || p == 511 ? 0 : from + p * (1 << shift);
            };
            add(v0);
            add(v0 == 0 && v1 > 0 ? predicted(p1, v1, nextLevel) : predicted(p1, v0, level));
            add(predicted(p2, v1, nextLevel));
        }
    } else if (type == 0x85) {
        for (int i = 0; i < 40; ++i)
            points.push_back({0, u16(b, 4 + 2 * i) / 1000.0});
    } else {
        for (int i = 0; i < 32; ++i) {
            const unsigned c = u8(b, 14 + 5 * i);
            for (const unsigned w :
                 {u16(b, 10 + 5 * i) | (c & 15) << 16, u16(b, 12 + 5 * i) | c >> 4 << 16}) {
                static const int base[] = {0, 2046, 8187, 24567}, bits[] = {10, 11, 12, 13};
                const int scale = w & 3, steps = int(w >> 2) & ((1 << bits[scale]) - 1);
                points.push_back(
                    {0, (base[scale] + (scale + 2) * steps) / 1000.0, scale == 0 ? int(w >> 12) : 0});
            }
        }
    }
    return points;
}

/// Packets 82, 84, 85, 86: the points of each but the last one.
inline Reading readRplidar(unsigned type, const QByteArray &bytes) {
    const int length = type == 0x84 ? 132 : type == 0x86 ? 170 : 84, startAt = type == 0x86 ? 8 : 2;
    Reading reading;
    QByteArray before;
    cutPackets(
        bytes, reading,
        [&](const QByteArray &b) {
            if (b.size() < length)
                return -1;
            unsigned sum = 0;
            for (int i = 2; i < length; ++i)
                sum ^= u8(b, i);
            return (u8(b, 0) == (0xA0 | (sum & 15)) && u8(b, 1) == (0x50 | sum >> 4)) ? length : 0;
        },
        [&](const QByteArray &b) {
            const unsigned start = u16(b, startAt);
            if (!before.isEmpty() && (start & 0x8000) == 0) {
                const double from = (u16(before, startAt) & 0x7FFF) / 64.0;
                std::vector<ReadPoint> points = pointsOfRplidar(type, before, b);
                const double width = circle(start / 64.0 - from) / double(points.size());
                for (std::size_t k = 0; k < points.size(); ++k) {
                    points[k].angle = circle(points[k].angle + from + double(k) * width);
                    reading.points.push_back(points[k]);
                }
            }
            before = b;
        });
    return reading;
}

inline Reading readLd(const QByteArray &bytes) {
    Reading reading;
    cutPackets(
        bytes, reading,
        [](const QByteArray &b) {
            if (b.size() < 47)
                return -1;
            unsigned crc = 0;
            for (int i = 0; i < 46; ++i) {
                crc ^= u8(b, i);
                for (int bit = 0; bit < 8; ++bit)
                    crc = ((crc << 1) ^ (crc & 0x80 ? 0x4D : 0)) & 0xFF;
            }
            return b.startsWith("\x54\x2C") && crc == u8(b, 46) ? 47 : 0;
        },
        [&](const QByteArray &b) {
            const double first = u16(b, 4) / 100.0, width = circle(u16(b, 42) / 100.0 - first);
            for (int i = 0; i < 12; ++i)
                reading.points.push_back(
                    {circle(first + width * i / 11), u16(b, 6 + 3 * i) / 1000.0, int(u8(b, 8 + 3 * i))});
            reading.stamps.push_back(u16(b, 44) / 1000.0);
        });
    return reading;
}

inline Reading readYdlidar(const QByteArray &bytes, bool intensity, bool timeOfFlight, bool corrected) {
    const int sampleSize = intensity ? 3 : 2;
    Reading reading;
    cutPackets(
        bytes, reading,
        [&](const QByteArray &b) {
            if (b.size() < 10)
                return -1;
            const int samples = int(u8(b, 3)), length = 10 + samples * sampleSize;
            if (!b.startsWith("\xAA\x55") || samples < 1 || samples > 80)
                return 0;
            if (b.size() < length)
                return -1;
            unsigned sum = u16(b, 0) ^ u16(b, 2) ^ u16(b, 4) ^ u16(b, 6);
            for (int at = 10; at < length; at += sampleSize)
                sum ^= intensity ? u8(b, at) ^ u16(b, at + 1) : u16(b, at);
            return sum == u16(b, 8) ? length : 0;
        },
        [&](const QByteArray &b) {
            const int samples = int(u8(b, 3));
            const double first = (u16(b, 4) >> 1) / 64.0, width = circle((u16(b, 6) >> 1) / 64.0 - first);
            for (int i = 0; i < samples; ++i) {
                const int at = 10 + i * sampleSize + intensity;
                const double mm = timeOfFlight ? u16(b, at) : u16(b, at) / 4.0;
                double angle = first + (samples > 1 ? width * i / (samples - 1) : 0);
                if (corrected && mm > 0)
                    angle += std::atan(21.8 * (155.3 - mm) / (155.3 * mm)) * 180 / M_PI;
                reading.points.push_back(
                    {circle(angle), mm / 1000, intensity ? int(u8(b, at - 1)) : 0, bool(b[2] & 1)});
            }
        });
    return reading;
}

/// Of SCIP 2: six bits a character.
inline int scipNumber(const QByteArray &text) {
    int value = 0;
    for (const char c : text)
        value = value << 6 | (c - 0x30);
    return value;
}

/// A line without its sum; null when that is wrong.
inline QByteArray scipLine(const QByteArray &line) {
    unsigned sum = 0;
    for (const char c : line.left(line.size() - 1))
        sum += std::uint8_t(c);
    return !line.isEmpty() && std::uint8_t(line.back()) == (sum & 0x3F) + 0x30 ? line.left(line.size() - 1)
                                                                               : QByteArray();
}

/// The scans that a device sends to MD or ME (then with intensities) of these steps.
inline Reading readScip(const QByteArray &bytes, int first, int front, int steps, bool intensity) {
    Reading reading;
    for (int begin = 0, end = 0; (end = bytes.indexOf("\n\n", begin)) >= 0; begin = end + 2) {
        const QList<QByteArray> lines = bytes.mid(begin, end - begin).split('\n');
        if (lines.size() < 3 || scipLine(lines[1]) != "99") {
            reading.strayBytes += end + 2 - begin;
            continue;
        }
        QByteArray values;
        for (int i = 3; i < lines.size(); ++i)
            values += scipLine(lines[i]);
        ++reading.packets;
        reading.stamps.push_back(scipNumber(scipLine(lines[2])) / 1000.0);
        const int size = intensity ? 6 : 3;
        for (int i = 0; i * size < values.size(); ++i)
            reading.points.push_back({circle(360.0 * (first + i - front) / steps),
                                      scipNumber(values.mid(i * size, 3)) / 1000.0,
                                      intensity ? scipNumber(values.mid(i * size + 3, 3)) : 0, i == 0});
    }
    return reading;
}

/// The telegrams LMDscandata of CoLa A; angles from straight ahead, stamps of the zero index and of sending.
inline Reading readCola(const QByteArray &bytes) {
    Reading reading;
    for (int begin = 0, end = 0; (end = bytes.indexOf('\x03', begin)) >= 0; begin = end + 1) {
        const QList<QByteArray> words = bytes.mid(begin, end - begin).split(' ');
        const int dist = words.indexOf("DIST1"), count = words.value(dist + 5).toInt(nullptr, 16);
        if (!words[0].startsWith("\x02s") || words.value(1) != "LMDscandata" || dist != 20 ||
            words.size() < dist + 6 + count) {
            reading.strayBytes += end + 1 - begin;
            continue;
        }
        const auto number = [&words](int at) { return words.value(at).toUInt(nullptr, 16); };
        const int second = words.indexOf("RSSI1");
        for (int i = 0; i < count; ++i) {
            const unsigned mm = number(dist + 6 + i);
            const double angle = std::int32_t(number(dist + 3)) / 1e4 + i * (number(dist + 4) / 1e4) - 90;
            reading.points.push_back({circle(angle), mm < 16 ? 0 : mm / 1000.0,
                                      second < 0 ? 0 : int(number(second + 6 + i)), i == 0});
        }
        ++reading.packets;
        reading.stamps.push_back(number(9) * 1e-6);
        reading.stamps.push_back(number(10) * 1e-6);
    }
    return reading;
}
