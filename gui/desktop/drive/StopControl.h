#pragma once

#include "gui/desktop/drive/StopLine.h"
#include "gui/desktop/model/Fleet.h"

#include <memory>

namespace hermes::desktop {

/// STOP for the chosen robot: every daemon of it that has an emergency stop gets it, those too that are away
/// at this moment or are found later. It goes on until the robot has measured that it stands, whatever robot
/// is chosen meanwhile.
class StopControl : public QObject {
    Q_OBJECT
public:
    /// Unconfirmed for longer it is said aloud.
    static constexpr double late_s = 0.5;

    explicit StopControl(Fleet &fleet, QObject *parent = nullptr);

    void press();
    /// Of the chosen robot.
    void release();

    /// Of the chosen robot: of the line that is least far.
    StopPhase phase() const;
    /// Of any robot.
    bool isLate() const;
    /// What the operator has to know now; empty: nothing.
    QString text() const;

Q_SIGNALS:
    void changed();

private:
    void follow();
    void reach(DaemonLink *daemon);
    bool isOfChosen(const StopLine &line) const;
    const StopLine *worst(bool ofAny) const;

    Fleet &fleet_;
    std::vector<std::unique_ptr<StopLine>> lines_;
    bool isPressed_ = false; ///< for whoever comes later, too
    QPointer<Robot> robot_;  ///< for which it was pressed; null: for any
};

} // namespace hermes::desktop
