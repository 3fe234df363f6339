#include "protocol/messages/Matching.h"

#include "protocol/wire/Fields.h"

namespace hermes {

Fields<PoseMessage> fieldsOf(Of<PoseMessage>) {
    return Fields<PoseMessage>()
        .include(&PoseMessage::pose)
        .addMaybe("twist", &PoseMessage::twist, "Velocity in the sensor's frame")
        .addOrNull("covariance", &PoseMessage::covariance,
                   "Of x, y and theta, row by row; null where the match leaves a direction open")
        .add("outcome", &PoseMessage::outcome, "Of the scan; lost: the pose is the expected one")
        .choices({"matched", "lost", "skipped"})
        .addMaybe("scan", &PoseMessage::scan, "The turn it belongs to")
        .addMaybe("trust", &PoseMessage::trust,
                  "How far to trust the pose, 0 to 1: how likely it is within 10 cm and 2 degrees of where "
                  "the map shows the same")
        .addMaybe("corrected", &PoseMessage::corrected,
                  "The map was corrected since the message before: the pose leapt, the robot did not")
        .addMaybe("upside_down", &PoseMessage::upsideDown,
                  "The scanner hangs so, or counts angles clockwise: y of its scan2d is to be negated")
        .addOrNull("map_to_odometry", &PoseMessage::odometryFrame,
                   "Where the frame of the odometry lies in the map; null without odometry. What follows a "
                   "path by the odometry and this stays smooth when the map is corrected");
}

Fields<StepTimes> fieldsOf(Of<StepTimes>) {
    return Fields<StepTimes>()
        .add("segment", &StepTimes::segment, "Segmentation", "ms")
        .add("vectorize", &StepTimes::vectorize, "Vectorization", "ms")
        .add("match", &StepTimes::match, "Matching", "ms")
        .add("map", &StepTimes::map, "Building the map", "ms");
}

Fields<MatchMessage> fieldsOf(Of<MatchMessage>) {
    return Fields<MatchMessage>()
        .addMaybe("scan", &MatchMessage::scan, "The turn it belongs to")
        .addMaybe("accepted", &MatchMessage::accepted, "The pose was taken over")
        .add("pairs", &MatchMessage::pairs, "Correspondences: id of the map's edge, index of the segment")
        .add("reliability", &MatchMessage::reliability, "0 to 1")
        .add("ambiguity", &MatchMessage::ambiguity, "Of the position", "m^2")
        .addMaybe("matched_length", &MatchMessage::matchedLength, "Of the segments in pairs", "m")
        .addMaybe("visible_length", &MatchMessage::visibleLength, "Of all segments", "m")
        .addMaybe("rms", &MatchMessage::rms, "Distance of the pairs", "m")
        .addMaybe("ms", &MatchMessage::ms, "Time of each step");
}

Fields<ScanResult> fieldsOf(Of<ScanResult>) {
    return Fields<ScanResult>()
        .add("stamp", &ScanResult::stamp, "Of the scan", "s")
        .add("pose", &ScanResult::pose, "As in the topic pose")
        .add("match", &ScanResult::match, "As in the topic match")
        .add("segments", &ScanResult::segments, "As in the topic segments: x1, y1, x2, y2 of each", "m");
}

} // namespace hermes
