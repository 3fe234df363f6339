#pragma once

#include "daemons/recorder/SessionReader.h"

namespace hermes::recorder {

/// Writes a session for other tools, into a folder, which is made where it is missing; files of these names
/// there are replaced. topics: * stands for any text but a slash; none: all, or those of the format.
///  csv:    a file a topic; its columns are the fields of the schema, lists are JSON
///  tum:    a file a topic that tells poses: stamp x y z qx qy qz qw; else scanmatcher/pose
///  carmen: ODOM lines and a ROBOTLASER1 line a scan, of motorcontrol/odometry and the scan2d of lidar or
///          scanner
///  mcap:   everything in one file; with the profile ros2, what hermes-ros2 would have told of it
///  pcap:   the packets of each lidar in one file; without topics
/// What is missing in them is told. Errors: InvalidParams (format, profile), NotReady (no such messages, or
/// it was to end early), InputOutput.
Result<SessionFiles> exportSession(SessionReader &session, const QString &format, const QStringList &topics,
                                   const QString &into, const QString &profile = {});
/// Of the captures in the folder of a session.
double captureBytes(const QString &folder);

} // namespace hermes::recorder
