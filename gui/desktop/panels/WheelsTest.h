#pragma once

#include "gui/desktop/model/Fleet.h"
#include "gui/setup/WheelSettings.h"
#include "gui/setup/WheelTurn.h"

#include <QWidget>

class QCheckBox;
class QComboBox;
class QPushButton;

namespace hermes::desktop {

class MessageLabel;

/// The test of the wheels of the chosen robot: turns one after another, once somebody has said that it is
/// lifted, and asks what was seen. It ends when the robot is stopped, another is chosen, or it is not in
/// sight: its dock is closed, or under another tab.
class WheelsTest : public QWidget {
    Q_OBJECT
public:
    explicit WheelsTest(Fleet &fleet, QWidget *parent = nullptr);

Q_SIGNALS:
    /// Each wheel was seen: the settings `wheels` of the motor control that are to change.
    void ended(const QJsonObject &changes);

protected:
    void showEvent(QShowEvent *event) override;
    void hideEvent(QHideEvent *event) override;

private:
    DaemonLink *motors() const;
    void updateButtons();
    void begin();
    void turnNext();
    void onTurned(const Result<double> &measured);
    void onSeen();
    void giveUp(const QString &why);
    void onSight(bool isInSight);
    bool isUnderWay() const { return !wheel_.isEmpty(); }

    Fleet &fleet_;
    Client client_; ///< of its own: nobody else drives with the control of this test
    WheelTurn turn_;
    QCheckBox *lifted_;
    QPushButton *test_, *next_;
    QComboBox *seenChoice_;
    MessageLabel *message_;
    QString wheel_; ///< that turns, or was told to turn; empty: no test
    WheelPlan plan_;
    std::map<QString, SeenWheel> seen_;
};

} // namespace hermes::desktop
