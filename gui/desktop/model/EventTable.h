#pragma once

#include "gui/desktop/model/Events.h"

#include <QAbstractTableModel>
#include <QTimer>
#include <chrono>
#include <vector>

namespace hermes::desktop {

/// Events as rows for a view, the latest first; brought up to date a few times a second, however many come.
class EventTable : public QAbstractTableModel {
    Q_OBJECT
public:
    enum Column { TimeColumn, LevelColumn, FromColumn, TextColumn, StateColumn, ColumnCount };
    static constexpr int IdRole = Qt::UserRole;
    static constexpr std::chrono::milliseconds refreshPeriod{100};

    EventTable(const Events &events, QObject *parent);

    /// Only these and worse are rows.
    void show(Event::Level least);
    int rowCount(const QModelIndex &parent = {}) const override {
        return parent.isValid() ? 0 : int(rows_.size());
    }
    int columnCount(const QModelIndex & = {}) const override { return ColumnCount; }
    QVariant data(const QModelIndex &index, int role) const override;
    QVariant headerData(int section, Qt::Orientation orientation, int role) const override;

private:
    void refresh();
    QString textOf(const Event &event, int column) const;

    const Events &events_;
    Event::Level least_ = Event::Level::Info;
    std::vector<Event> rows_;
    QTimer timer_;
};

} // namespace hermes::desktop
