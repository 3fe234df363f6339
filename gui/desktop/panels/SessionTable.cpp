#include "gui/desktop/panels/SessionTable.h"

#include "gui/desktop/Theme.h"
#include "gui/desktop/widgets/ForeignText.h"
#include "gui/desktop/widgets/Quantities.h"

#include <QCollator>
#include <QHeaderView>
#include <QLocale>
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

/// Seconds; nothing while it goes on. A recorder may be older than `duration_s`.
std::optional<double> lengthOf(const SessionSummary &session) {
    if (session.duration_s || !session.end)
        return session.duration_s;
    return std::max(0.0, *session.end - session.start);
}

QString sessionToolTip(const SessionSummary &session) {
    const auto start = timeOf(session.start);
    QStringList lines{shortLine(session.name)};
    lines.append(start ? QLocale().toString(*start, QLocale::ShortFormat)
                       : SessionTable::tr("at an impossible time: %1").arg(session.start));
    if (const auto length = lengthOf(session))
        lines.append(SessionTable::tr("%1, %2").arg(durationText(*length), sizeText(session.bytes)));
    lines.append(session.daemons.join(", "));
    lines.append(session.problems.isEmpty() ? SessionTable::tr("complete") : session.problems.join('\n'));
    return toolTipOf(lines.join('\n'));
}

} // namespace

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
    setTextElideMode(Qt::ElideMiddle); // of a name that is a date both ends say something
    setUniformRowHeights(true);
    setMinimumHeight(70);
    setSortingEnabled(true);
    sortByColumn(Date, Qt::DescendingOrder);
    setColumnHidden(Size, true);     // until there is room; the name needs it more
    setEditTriggers(NoEditTriggers); // but by askForName()
    connect(this, &QTreeWidget::itemChanged, this, &SessionTable::takeName);
}

/// As low as it can be: what is told below it is to be seen.
QSize SessionTable::sizeHint() const {
    return {QTreeWidget::sizeHint().width(), minimumHeight()};
}

void SessionTable::resizeEvent(QResizeEvent *event) {
    QTreeWidget::resizeEvent(event);
    if (std::exchange(hasRoom_, viewport()->width() >= roomyWidth) == hasRoom_)
        return;
    setColumnHidden(Size, !hasRoom_);
    showDates();
}

void SessionTable::showDates() {
    for (int i = 0; i < topLevelItemCount(); ++i) {
        QTreeWidgetItem *const row = topLevelItem(i);
        const int index = row->data(Name, indexRole).toInt();
        row->setText(Date, dateText(sessions_[std::size_t(index)].start, hasRoom_));
    }
}

const SessionSummary *SessionTable::sessionOf(const QTreeWidgetItem *item) const {
    const int index = item ? item->data(Name, indexRole).toInt() : -1;
    return index >= 0 && index < int(sessions_.size()) ? &sessions_[std::size_t(index)] : nullptr;
}

void SessionTable::askForName() {
    if (currentItem())
        editItem(currentItem(), Name);
}

void SessionTable::takeName(QTreeWidgetItem *item) {
    const SessionSummary *const session = sessionOf(item);
    const QString to = item->text(Name).trimmed();
    if (session && !to.isEmpty() && to != shortLine(session->name, longestName))
        Q_EMIT renameWanted(session->name, to);
}

/// Rows that stay are the same: a double click may be half done.
void SessionTable::tell(const std::vector<SessionSummary> &sessions) {
    const auto keyOf = [](const SessionSummary &session) { return session.session + '/' + session.name; };
    const QString before = chosen() ? keyOf(*chosen()) : QString();
    QMultiHash<QString, QTreeWidgetItem *> rows;
    for (int i = 0; i < topLevelItemCount(); ++i)
        rows.insert(keyOf(*sessionOf(topLevelItem(i))), topLevelItem(i));
    const QSignalBlocker silence(this);
    setSortingEnabled(false); // once, when all are here
    sessions_ = sessions;
    QTreeWidgetItem *current = nullptr;
    for (std::size_t i = 0; i < sessions_.size(); ++i) {
        const QString key = keyOf(sessions_[i]);
        QTreeWidgetItem *row = rows.take(key);
        if (!row) {
            addTopLevelItem(row = new Row);
            row->setFlags(row->flags() | Qt::ItemIsEditable);
        }
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

void SessionTable::fill(QTreeWidgetItem &item, const SessionSummary &session) const {
    auto &row = static_cast<Row &>(item);
    row.setText(Name, shortLine(session.name, longestName));
    const auto length = lengthOf(session);
    row.setIcon(Name, theme::icon(!length                      ? Condition::Busy
                                  : session.problems.isEmpty() ? Condition::Ready
                                                               : Condition::Warning));
    row.setValue(Date, session.start, dateText(session.start, hasRoom_));
    row.setValue(Duration, length.value_or(0), length ? durationText(*length) : tr("goes on"));
    row.setValue(Size, session.bytes, sizeText(session.bytes));
    for (const SessionColumn column : {Name, Date, Duration, Size})
        row.setToolTip(column, sessionToolTip(session));
    for (const SessionColumn column : {Duration, Size})
        row.setTextAlignment(column, Qt::AlignRight | Qt::AlignVCenter);
}

} // namespace hermes::desktop
