#pragma once

#include "gui/session/SessionList.h"

#include <QTreeWidget>

namespace hermes::desktop {

/// The name with the next number that no recording has: run1, run2.
QString nextFreeName(const QString &name, const SessionList &list);

/// The recordings of a robot with date, duration and size, in the order that its header is clicked for.
class SessionTable : public QTreeWidget {
    Q_OBJECT
public:
    explicit SessionTable(QWidget *parent = nullptr);

    /// The one that was chosen stays so; where none was, the latest is.
    void tell(const SessionList &list);
    const std::vector<RecordedSession> &sessions() const { return sessions_; }
    /// Null: none.
    const RecordedSession *chosen() const;
    QSize sizeHint() const override;

protected:
    void resizeEvent(QResizeEvent *event) override;

private:
    void showDates();
    void fill(QTreeWidgetItem &item, const RecordedSession &session) const;

    std::vector<RecordedSession> sessions_;
    bool hasRoom_ = false; ///< for dates with the time of the day
};

} // namespace hermes::desktop
