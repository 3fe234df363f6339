#pragma once

#include <QWidget>

#include <vector>

namespace hermes::desktop {

/// A line from 0 to a duration on which a time is shown and taken with the mouse, by a click or by dragging,
/// or with Page Up, Page Down and Home. Marks stand on it, and are named in its tool tip.
class Timeline : public QWidget {
    Q_OBJECT
public:
    struct Mark {
        double t_s = 0;
        QString text;
    };
    static constexpr double longest_s = 1e7; ///< four months
    static constexpr double step_s = 10;     ///< of Page Up and Page Down

    explicit Timeline(QWidget *parent = nullptr);

    /// What is not between 0 and longest_s is not known: nothing can be taken then.
    void setDuration(double seconds);
    double duration_s() const { return duration_s_; }
    /// Without effect while it is dragged.
    void setPosition(double seconds);
    double position_s() const { return position_s_; }
    void setMarks(std::vector<Mark> marks);
    const std::vector<Mark> &marks() const { return marks_; }

    /// As if the mouse had taken it there.
    void take(double seconds);
    bool isHeld() const { return isHeld_; }

    /// Where a time stands in the widget.
    QPoint pointOf(double seconds) const;
    QSize sizeHint() const override;

Q_SIGNALS:
    /// The mouse has taken it, or let it go.
    void heldChanged(bool isHeld);
    void sought(double seconds);

protected:
    bool event(QEvent *event) override;
    void paintEvent(QPaintEvent *event) override;
    void mousePressEvent(QMouseEvent *event) override;
    void mouseMoveEvent(QMouseEvent *event) override;
    void mouseReleaseEvent(QMouseEvent *event) override;
    void keyPressEvent(QKeyEvent *event) override;
    void hideEvent(QHideEvent *event) override;

private:
    double timeAt(int x) const;
    QString textAt(int x) const;
    void letGo();

    double duration_s_ = 0, position_s_ = 0;
    std::vector<Mark> marks_;
    bool isHeld_ = false;
};

} // namespace hermes::desktop
