#include "daemons/velodynelogger/TurnText.h"

#include <charconv>

namespace hermes::velodynelogger {

namespace {

constexpr std::int64_t second_ns = 1000000000;

template <typename Number>
void append(std::string &text, Number number) {
    char digits[32];
    text.append(digits, std::to_chars(digits, digits + sizeof digits, number).ptr);
}

template <typename Number>
void appendMetres(std::string &text, Number metres) {
    append(text, metres == 0 ? Number(0) : metres); // never "-0"
}

/// "1700000000.123456789": more digits than a double has.
void appendSeconds(std::string &text, std::int64_t stamp_ns) {
    if (stamp_ns < 0)
        text += '-';
    const std::uint64_t size_ns = std::uint64_t(stamp_ns < 0 ? -stamp_ns : stamp_ns);
    const std::string fraction = std::to_string(size_ns % second_ns);
    append(text, size_ns / second_ns);
    text += '.' + std::string(9 - fraction.size(), '0') + fraction;
}

/// What a comment in a header tells: which turn it is and when it began.
std::string describe(const velodyne::Turn &turn) {
    std::string text =
        std::string(turn.model->name) + ", turn " + std::to_string(turn.number) + ", first firing at ";
    appendSeconds(text, turn.begin_ns);
    return text + " s since 1970 UTC; x ahead, y left, z up, metres; t seconds after the first firing\n";
}

void appendCsv(std::string &text, const velodyne::Turn &turn, const velodyne::Point &point) {
    append(text, turn.number);
    text += ',';
    appendSeconds(text, point.stamp_ns);
    text += ',';
    append(text, int(point.laser));
    for (const double value : {point.azimuth, point.range}) {
        text += ',';
        append(text, value);
    }
    text += ',';
    append(text, int(point.intensity));
    for (const double value : {point.x, point.y, point.z}) {
        text += ',';
        appendMetres(text, value);
    }
    text += '\n';
}

} // namespace

TurnFormat turnFormatFromText(std::string_view text) {
    return text == "pcd" ? TurnFormat::Pcd : text == "ply" ? TurnFormat::Ply : TurnFormat::Csv;
}

std::string turnHeader(const velodyne::Turn &turn, TurnFormat format) {
    const std::string count = std::to_string(turn.points.size());
    switch (format) {
    case TurnFormat::Csv:
        return "turn,stamp,laser,azimuth,range,intensity,x,y,z\n";
    case TurnFormat::Pcd:
        return "# .PCD v0.7 - Point Cloud Data file format\n# " + describe(turn) +
               "VERSION 0.7\nFIELDS x y z intensity ring t\nSIZE 4 4 4 4 2 4\nTYPE F F F F U F\n"
               "COUNT 1 1 1 1 1 1\nWIDTH " +
               count + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + count + "\nDATA ascii\n";
    case TurnFormat::Ply:
        return "ply\nformat ascii 1.0\ncomment " + describe(turn) + "element vertex " + count +
               "\nproperty float x\nproperty float y\nproperty float z\nproperty float intensity\n"
               "property ushort ring\nproperty float t\nend_header\n";
    }
    return {};
}

void appendPoint(std::string &text, const velodyne::Turn &turn, const velodyne::Point &point,
                 TurnFormat format) {
    if (format == TurnFormat::Csv)
        return appendCsv(text, turn, point);
    for (const double value : {point.x, point.y, point.z}) {
        appendMetres(text, float(value));
        text += ' ';
    }
    append(text, int(point.intensity));
    text += ' ';
    append(text, turn.model->ring(point.laser));
    text += ' ';
    append(text, float(double(point.stamp_ns - turn.begin_ns) * 1e-9));
    text += '\n';
}

} // namespace hermes::velodynelogger
