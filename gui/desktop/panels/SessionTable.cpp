#include "gui/desktop/panels/SessionTable.h"

#include "gui/desktop/Theme.h"
#include "gui/desktop/widgets/ForeignText.h"
#include "gui/desktop/widgets/Quantities.h"

#include <QCollator>
#include <QHeaderView>
#include <QLocale>
#include <QRegularExpression>
#include <cmath>

namespace hermes::desktop {
namespace {

enum SessionColumn { Name, Date, Duration, Size };
constexpr int indexRole = Qt::UserRole;     // of the name: which session
constexpr int valueRole = Qt::UserRole + 1; // of the others: what they are sorted by
constexpr int roomyWidth = 420;             // pixels

class Row : public QTreeWidgetItem {
public:
    bool operator<(const QTreeWidgetItem &other) const override {
        const int column = treeWidget()->sortColumn();
        if (column > Name)
            return data(column, valueRole).toDouble() < other.data(column, valueRole).toDouble();
        static const QCollator collator = [] {
            QCollator numbers(QLocale(QLocale::English)); // the plain one knows no numbers
            numbers.setNumericMode(true);                 // run2 before run10
            return numbers;
        }();
        return collator.compare(text(Name), other.text(Name)) < 0;
    }
    void setValue(int column, double value, const QString &text) {
        setText(column, text);
        setData(column, valueRole, std::isfinite(value) ? value : 0); // what is no number has no order
    }
};

/// Keeps no room for the arrow in columns that have none: the panel is narrow.
class Header : public QHeaderView {
public:
    Header()
        : QHeaderView(Qt::Horizontal) {
        setSectionsClickable(true);
        setHighlightSections(false);
    }

protected:
    QSize sectionSizeFromContents(int section) const override {
        const QSize size = QHeaderView::sectionSizeFromContents(section);
        const bool hasRoom = !isSortIndicatorShown() || section == sortIndicatorSection();
        const int arrow = size.height() + style()->pixelMetric(QStyle::PM_HeaderMargin, nullptr, this);
        return {size.width() - (hasRoom ? 0 : arrow), size.height()};
    }
};

QString keyOf(const RecordedSession &session) {
    return session.id + '/' + session.name;
}

/// The tool tip has it in full.
QString dateText(double stamp, bool hasRoom) {
    const auto start = timeOf(stamp);
    if (!start)
        return SessionTable::tr("impossible");
    if (start->date() == QDate::currentDate() && !hasRoom)
        return QLocale().toString(*start, "HH:mm");
    const bool isThisYear = start->date().year() == QDate::currentDate().year();
    return QLocale().toString(*start,
                              (isThisYear ? QString("d MMM") : "d MMM yyyy") + (hasRoom ? " HH:mm" : ""));
}

QString sessionToolTip(const RecordedSession &session) {
    const auto start = timeOf(session.start);
    QStringList lines{start ? QLocale().toString(*start, QLocale::ShortFormat)
                            : SessionTable::tr("at an impossible time: %1").arg(session.start)};
    for (const SessionPart &part : session.parts)
        lines.append(SessionTable::tr("%1: %2, %3")
                         .arg(part.member.name, countsText(part.entry["counts"]),
                              part.fault().isEmpty() ? SessionTable::tr("complete") : part.fault()));
    return toolTipOf(lines.join('\n'));
}

} // namespace

QString nextFreeName(const QString &name, const SessionList &list) {
    QStringList taken;
    for (const RecordedSession &session : list.sessions)
        taken.append(session.name);
    static const QRegularExpression numbered("^(.*?)([0-9]{0,6})$",
                                             QRegularExpression::DotMatchesEverythingOption);
    const QRegularExpressionMatch match = numbered.match(name);
    const QString digits = match.captured(2);
    QString next = name;
    for (int number = digits.isEmpty() ? 2 : digits.toInt() + 1; taken.contains(next); ++number)
        next = match.captured(1) + QString("%1").arg(number, digits.size(), 10, QChar('0'));
    return next;
}

SessionTable::SessionTable(QWidget *parent)
    : QTreeWidget(parent) {
    setObjectName("sessions");
    setAccessibleName(tr("What was recorded"));
    setHeader(new Header);
    setHeaderLabels({tr("Name"), tr("Date"), tr("Length"), tr("Size")});
    header()->setStretchLastSection(false);
    header()->setMinimumSectionSize(50);
    header()->setSectionResizeMode(QHeaderView::ResizeToContents);
    header()->setSectionResizeMode(Name, QHeaderView::Stretch);
    setRootIsDecorated(false);
    setUniformRowHeights(true);
    setMinimumHeight(70);
    setSortingEnabled(true);
    sortByColumn(Date, Qt::DescendingOrder);
}

/// As low as it can be: what is told below it is to be seen.
QSize SessionTable::sizeHint() const {
    return {QTreeWidget::sizeHint().width(), minimumHeight()};
}

void SessionTable::resizeEvent(QResizeEvent *event) {
    QTreeWidget::resizeEvent(event);
    if (std::exchange(hasRoom_, viewport()->width() >= roomyWidth) != hasRoom_)
        showDates();
}

void SessionTable::showDates() {
    for (int i = 0; i < topLevelItemCount(); ++i) {
        QTreeWidgetItem *const row = topLevelItem(i);
        const int index = row->data(Name, indexRole).toInt();
        row->setText(Date, dateText(sessions_[std::size_t(index)].start, hasRoom_));
    }
}

const RecordedSession *SessionTable::chosen() const {
    const QTreeWidgetItem *const item = currentItem();
    const int index = item ? item->data(Name, indexRole).toInt() : -1;
    return index >= 0 && index < int(sessions_.size()) ? &sessions_[std::size_t(index)] : nullptr;
}

/// Rows that stay are the same: a double click may be half done.
void SessionTable::tell(const SessionList &list) {
    const QString before = chosen() ? keyOf(*chosen()) : QString();
    QMultiHash<QString, QTreeWidgetItem *> rows;
    for (int i = 0; i < topLevelItemCount(); ++i) {
        QTreeWidgetItem *const row = topLevelItem(i);
        rows.insert(keyOf(sessions_[std::size_t(row->data(Name, indexRole).toInt())]), row);
    }
    const QSignalBlocker silence(this);
    setSortingEnabled(false); // once, when all are here
    sessions_ = list.sessions;
    QTreeWidgetItem *current = nullptr;
    for (std::size_t i = 0; i < sessions_.size(); ++i) {
        const QString key = keyOf(sessions_[i]);
        QTreeWidgetItem *row = rows.take(key);
        if (!row)
            addTopLevelItem(row = new Row);
        row->setData(Name, indexRole, int(i));
        fill(*row, sessions_[i]);
        if (!current || key == before) // the latest is the first
            current = row;
    }
    qDeleteAll(rows);
    setSortingEnabled(true);
    if (current)
        setCurrentItem(current);
}

void SessionTable::fill(QTreeWidgetItem &item, const RecordedSession &session) const {
    auto &row = static_cast<Row &>(item);
    const double duration_s = session.end - session.start;
    row.setText(Name, shortLine(session.name, longestName));
    row.setIcon(Name, theme::icon(session.faults().isEmpty() ? Condition::Ready
                                  : session.goesOn()         ? Condition::Busy
                                                             : Condition::Warning));
    row.setValue(Date, session.start, dateText(session.start, hasRoom_));
    row.setValue(Duration, duration_s, session.goesOn() ? tr("goes on") : durationText(duration_s));
    // Of one that goes on it is what was known when it began.
    row.setValue(Size, session.bytes(), session.goesOn() ? QString() : sizeText(session.bytes()));
    for (const SessionColumn column : {Name, Date, Duration, Size})
        row.setToolTip(column, sessionToolTip(session));
    for (const SessionColumn column : {Duration, Size})
        row.setTextAlignment(column, Qt::AlignRight | Qt::AlignVCenter);
}

} // namespace hermes::desktop
