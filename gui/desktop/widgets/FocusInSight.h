#pragma once

#include <QWidget>

namespace hermes::desktop {

/// What is not seen has no focus: a key that would go to what lies behind a tab, or in a part that was drawn
/// shut, goes nowhere, and the focus goes to fallback. Its letter with Alt does not press it either.
class FocusInSight : public QObject {
public:
    explicit FocusInSight(QWidget &fallback);

    /// Gives the focus to the next widget of a window that Tab leads to and that is seen, or can be scrolled
    /// to. isNext: false: to the one before. False: there is none.
    static bool move(const QWidget &window, bool isNext);

protected:
    bool eventFilter(QObject *watched, QEvent *event) override;

private:
    QWidget &fallback_;
};

} // namespace hermes::desktop
