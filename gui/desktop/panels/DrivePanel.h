#pragma once

#include "gui/desktop/drive/DriveControl.h"

#include <QWidget>

class QBoxLayout;
class QLayout;
class QLineEdit;
class QPushButton;
class QSlider;

namespace hermes::desktop {

class DriveGamepad;

class AgedLabel;
class MessageLabel;
class PlainLabel;
class Stick;

/// Drives by hand: stick, speed limit in m/s, the velocity that is commanded and the one that is measured,
/// who has the control.
class DrivePanel : public QWidget {
    Q_OBJECT
public:
    DrivePanel(DriveControl &drive, DriveGamepad &gamepad, QWidget *parent = nullptr);

protected:
    void resizeEvent(QResizeEvent *event) override;

private:
    void update();
    QString freeText() const;
    QWidget *makeNumbers();
    QLayout *makeLimit();
    void showLimit();
    void takeTypedLimit();
    void setLimit(double share);
    void refuseLimit(const QString &why);

    DriveControl &drive_;
    QBoxLayout *top_; ///< the stick, and its limit beside or below it
    Stick *stick_;
    QSlider *limit_; // of the largest speed, in percent
    QLineEdit *speed_;
    PlainLabel *turn_;
    AgedLabel *control_;
    MessageLabel *problem_;
    PlainLabel *commanded_[3];
    AgedLabel *measured_[3];
    QPushButton *takeOver_, *blind_;
    QString wrongLimit_;  ///< why the last one was refused
    QString told_;        ///< last, as a problem
    QString problemThen_; ///< what was told then
};

} // namespace hermes::desktop
