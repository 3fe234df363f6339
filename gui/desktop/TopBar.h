#pragma once

#include "gui/desktop/drive/DriveControl.h"

#include <QWidget>

class QComboBox;
class QLabel;
class QPushButton;

namespace hermes {

/// What is always in sight: which robot, how good its link is, who has the control, the battery, STOP.
class TopBar : public QWidget {
    Q_OBJECT
public:
    TopBar(Fleet &fleet, DriveControl &drive, QWidget *parent = nullptr);

private:
    void updateRobots();
    void updateLink();
    void updateDrive();
    void showBattery(const QJsonValue &power);

    Fleet &fleet_;
    DriveControl &drive_;
    TopicFeed power_;
    QComboBox *robots_;
    QLabel *link_, *control_, *battery_;
    QPushButton *release_, *stop_;
};

} // namespace hermes
