#pragma once

#include <QObject>
#include <optional>

namespace hermes::desktop {

/// Which time all charts show: so many seconds before now, or before a now that is held; and where the cursor
/// is. Times are in seconds after that now, so at most 0.
class TimeWindow : public QObject {
    Q_OBJECT
public:
    static constexpr double shortest_s = 0.5, longest_s = 600, usual_s = 30;

    using QObject::QObject;

    double span_s() const { return span_s_; }
    double right_s() const { return right_s_; }
    double left_s() const { return right_s_ - span_s_; }
    /// The picture stands still.
    bool isHeld() const { return isHeld_; }
    const std::optional<double> &cursor_s() const { return cursor_s_; }

    void setSpan(double span_s);
    /// Shows less (factor above 1) or more, about the time at this share of the width; when it is not held,
    /// up to now.
    void zoom(double factor, double share);
    /// Holds the picture and goes back in it, or on (positive); beyond now it lets go.
    void pan(double seconds);
    /// Where the picture begins that is kept.
    void goToBegin() { pan(-longest_s); }
    void setHeld(bool isHeld);
    void setCursor(const std::optional<double> &time_s);

Q_SIGNALS:
    void changed();
    void cursorMoved();

private:
    double span_s_ = usual_s, right_s_ = 0;
    bool isHeld_ = false;
    std::optional<double> cursor_s_;
};

/// "0.5 s", "30 s", "1 min 15 s".
QString spanText(double span_s);

} // namespace hermes::desktop
