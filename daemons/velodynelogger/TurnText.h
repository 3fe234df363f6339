#pragma once

#include "protocol/velodyne/TurnAssembler.h"

#include <string>

namespace hermes::velodynelogger {

/// Kinds of file that a turn can be written to, all of them text.
enum class TurnFormat {
    Csv, ///< turn, stamp, laser, azimuth, range, intensity, x, y, z: as hermes-vector ring --all prints them
    Pcd, ///< Point Cloud Library: x, y, z, intensity, ring (0 is the lowest), t (s after the first firing)
    Ply, ///< Stanford polygon file, the same as properties
};

/// Of "pcd" and "ply"; Csv for all else.
TurnFormat turnFormatFromText(std::string_view text);

/// What stands before the points.
std::string turnHeader(const velodyne::Turn &turn, TurnFormat format);
/// Appends the line of a point. Numbers have all their digits: those of a double in CSV, of a float, as the
/// headers say, in the others. Metres, degrees clockwise, seconds since the Unix epoch.
void appendPoint(std::string &text, const velodyne::Turn &turn, const velodyne::Point &point,
                 TurnFormat format);

} // namespace hermes::velodynelogger
