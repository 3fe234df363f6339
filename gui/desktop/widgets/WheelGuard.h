#pragma once

#include <QObject>

class QWidget;

namespace hermes::desktop {

/// The wheel scrolls, and changes no value: over lists, numbers and sliders it goes to what lies behind them.
class WheelGuard : public QObject {
    Q_OBJECT
public:
    explicit WheelGuard(QWidget &window);

protected:
    bool eventFilter(QObject *watched, QEvent *event) override;
};

} // namespace hermes::desktop
