#pragma once

#include "gui/desktop/drive/DriveControl.h"

#include <QWidget>

class QComboBox;
class QPushButton;

namespace hermes::desktop {

class AgedLabel;
class PlainLabel;

/// What is always in sight: which robot, how good its link is, who has the control, battery, currents and
/// temperature, STOP.
class TopBar : public QWidget {
    Q_OBJECT
public:
    TopBar(Fleet &fleet, DriveControl &drive, QWidget *parent = nullptr);
    QPushButton &stopButton() { return *stop_; }

Q_SIGNALS:
    /// The operator has chosen a robot in the list.
    void robotTaken();

private:
    void updateRobots();
    void updateLink();
    void updateDrive();
    void showPower(WireView told);

    Fleet &fleet_;
    DriveControl &drive_;
    TopicFeed powerFeed_;
    Freshness powerAge_;
    QComboBox *robots_;
    PlainLabel *link_;
    AgedLabel *control_, *power_;
    QPushButton *release_, *stop_;
};

} // namespace hermes::desktop
