#include "gui/desktop/model/EventTable.h"

#include "gui/desktop/Theme.h"
#include "gui/desktop/widgets/ForeignText.h"

#include <algorithm>

namespace hermes::desktop {
namespace {

Condition conditionOf(const Event &event) {
    if (event.isOver && event.isAcknowledged)
        return Condition::Unreachable; // grey
    return event.level == Event::Level::Error     ? Condition::Fault
           : event.level == Event::Level::Warning ? Condition::Warning
                                                  : Condition::Busy;
}

} // namespace

EventTable::EventTable(const Events &events, QObject *parent)
    : QAbstractTableModel(parent)
    , events_(events) {
    timer_.setSingleShot(true);
    connect(&timer_, &QTimer::timeout, this, &EventTable::refresh);
    connect(&events, &Events::changed, &timer_, [this] {
        if (!timer_.isActive())
            timer_.start(refreshPeriod);
    });
    refresh();
}

void EventTable::show(Event::Level least) {
    least_ = least;
    refresh();
}

void EventTable::refresh() {
    beginResetModel();
    rows_.clear();
    for (auto event = events_.all().rbegin(); event != events_.all().rend(); ++event)
        if (event->level >= least_)
            rows_.push_back(*event);
    std::stable_sort(rows_.begin(), rows_.end(),
                     [](const Event &a, const Event &b) { return a.stamp > b.stamp; });
    endResetModel();
}

QString EventTable::textOf(const Event &event, int column) const {
    switch (column) {
    case TimeColumn: {
        const QDateTime time = timeOf(event.stamp).value_or(QDateTime());
        return time.toString(time.date() == QDate::currentDate() ? "HH:mm:ss" : "yyyy-MM-dd HH:mm:ss");
    }
    case LevelColumn:
        return event.level == Event::Level::Error     ? tr("error")
               : event.level == Event::Level::Warning ? tr("warning")
                                                      : tr("note");
    case FromColumn:
        return event.from;
    case TextColumn:
        return event.times > 1 ? tr("%1 (%2 times)").arg(event.text).arg(event.times) : event.text;
    default:
        return event.level == Event::Level::Info ? QString()
               : !event.isOver                   ? tr("goes on")
               : event.isAcknowledged            ? tr("over, seen")
                                                 : tr("over");
    }
}

QVariant EventTable::data(const QModelIndex &index, int role) const {
    if (!index.isValid() || index.row() >= int(rows_.size()))
        return {};
    const Event &event = rows_[std::size_t(index.row())];
    switch (role) {
    case Qt::DisplayRole:
        return textOf(event, index.column());
    case Qt::ToolTipRole:
        return toolTipOf(event.text);
    case Qt::DecorationRole:
        return index.column() == LevelColumn ? theme::icon(conditionOf(event)) : QVariant();
    case Qt::ForegroundRole:
        return event.level == Event::Level::Info ? QVariant() : theme::colour(conditionOf(event));
    case IdRole:
        return event.id;
    default:
        return {};
    }
}

QVariant EventTable::headerData(int section, Qt::Orientation orientation, int role) const {
    if (orientation != Qt::Horizontal || role != Qt::DisplayRole)
        return {};
    return QStringList{tr("Time"), tr("Level"), tr("From"), tr("What"), tr("State")}.value(section);
}

} // namespace hermes::desktop
