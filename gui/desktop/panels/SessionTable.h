#pragma once

#include "protocol/messages/Sessions.h"

#include <QTreeWidget>

namespace hermes::desktop {

/// The sessions of a robot with date, duration and size, in the order that its header is clicked for.
class SessionTable : public QTreeWidget {
    Q_OBJECT
public:
    explicit SessionTable(QWidget *parent = nullptr);

    /// The one that was chosen stays so; where none was, the latest is.
    void tell(const std::vector<SessionSummary> &sessions);
    /// Null: none.
    const SessionSummary *chosen() const { return sessionOf(currentItem()); }
    /// Has another name typed for the chosen one.
    void askForName();
    QSize sizeHint() const override;

Q_SIGNALS:
    void renameWanted(const QString &name, const QString &to);

protected:
    void resizeEvent(QResizeEvent *event) override;

private:
    void showDates();
    const SessionSummary *sessionOf(const QTreeWidgetItem *item) const;
    void takeName(QTreeWidgetItem *item);
    void fill(QTreeWidgetItem &item, const SessionSummary &session) const;

    std::vector<SessionSummary> sessions_;
    bool hasRoom_ = false; ///< for dates with the time of the day
};

} // namespace hermes::desktop
