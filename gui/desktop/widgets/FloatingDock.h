#pragma once

#include <QDockWidget>
#include <optional>

namespace hermes::desktop {

/// A dock that is seen to float: taken out by its button it moves off its old place, and it lies before the
/// window that it belongs to when that is shown.
class FloatingDock : public QDockWidget {
    Q_OBJECT
public:
    static constexpr int step = 40; ///< pixels, up and to the right

    FloatingDock(const QString &title, QWidget *parent);
    /// While an arrangement is restored, places are those that were kept.
    void setRestoring(bool isRestoring) { isRestoring_ = isRestoring; }
    /// Before the window, if it floats.
    void comeForward();

protected:
    bool focusNextPrevChild(bool isNext) override;

private:
    void moveOff(bool isFloating);

    bool isRestoring_ = false;
    std::optional<QPoint> place_; // to which it floats again
};

} // namespace hermes::desktop
