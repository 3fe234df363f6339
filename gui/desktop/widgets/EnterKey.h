#pragma once

#include "gui/desktop/widgets/TypingWatch.h"

class QWidget;

namespace hermes::desktop {

/// Enter does what Space does in other programs, where it is STOP in this one: it presses the button and
/// ticks the item that has the focus.
class EnterKey : public QObject {
    Q_OBJECT
public:
    EnterKey(const TypingWatch &typing, QWidget &window);

protected:
    bool eventFilter(QObject *watched, QEvent *event) override;

private:
    const TypingWatch &typing_;
    QWidget &window_;
};

} // namespace hermes::desktop
