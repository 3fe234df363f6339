#pragma once

#include <QString>

namespace hermes::recorder {

/// What a cause of MotionHold says of a halt.
struct HaltCause {
    enum class Kind {
        Wish,   ///< somebody wished to end the drive, or nobody drove
        Fault,  ///< nobody's wish; of a robot that stood it explains nothing
        Latched ///< the same, and it counts also where the robot stood
    };

    QString text; ///< for people
    Kind kind;

    bool isFault() const { return kind != Kind::Wish; }
};

/// One that is not known is a fault that holds, and is called as it is.
HaltCause haltCause(const QString &word);

} // namespace hermes::recorder
