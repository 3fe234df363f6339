#include "gui/desktop/panels/MessageView.h"

#include "gui/desktop/model/TopicFields.h"
#include "gui/desktop/widgets/Arrangement.h"
#include "gui/desktop/widgets/PlainLabel.h"
#include "gui/desktop/widgets/Seen.h"

#include <QHeaderView>
#include <cmath>

namespace hermes::desktop {
namespace {

constexpr int maxRows = 400, maxOfOne = 40, deepestShown = 8, longestShown = 120;
constexpr double rate_hz = 10, heavyRate_hz = 2;

QString wireNumberText(WireView value) {
    constexpr double largestWhole = 9007199254740992; // 2^53
    const double number = value.number();
    if (number == std::floor(number) && std::abs(number) < largestWhole)
        return QString::number(number, 'f', 0);
    const bool isLong = std::abs(number) >= 1e5 && std::abs(number) < 1e12; // a stamp, say
    return isLong ? QString::number(number, 'f', 3) : QString::number(number, 'g', 6);
}

QString textOf(WireView value) {
    switch (value.kind()) {
    case WireView::Kind::Number:
        return wireNumberText(value);
    case WireView::Kind::Boolean:
        return value.boolean() ? QObject::tr("yes") : QObject::tr("no");
    case WireView::Kind::Text:
        return shortLine(value.text(), longestShown);
    case WireView::Kind::Array:
        return QObject::tr("%1 in a list").arg(value.size());
    case WireView::Kind::Object:
        return {};
    default:
        return QObject::tr("nothing");
    }
}

void setText(QTreeWidgetItem &item, int column, const QString &text) {
    if (item.text(column) != text)
        item.setText(column, text);
}

QTreeWidgetItem *rowAt(QTreeWidgetItem &item, int index) {
    return index < item.childCount() ? item.child(index) : new QTreeWidgetItem(&item);
}

} // namespace

MessageView::MessageView(QWidget *parent)
    : QWidget(parent)
    , head_(named(new PlainLabel, "messageHead"))
    , tree_(named(new QTreeWidget, "newestMessage",
                  tr("The newest message of the topic that is chosen on the left"))) {
    head_->setMinimumWidth(1);
    tree_->setAccessibleName(tr("The newest message"));
    tree_->setUniformRowHeights(true);
    tree_->setHeaderLabels({tr("Name"), tr("Value"), tr("Unit")});
    tree_->header()->resizeSection(0, 180);
    tree_->header()->resizeSection(1, 200);
    filled(this, inColumn({head_, {tree_, 1}}));
    connect(&timer_, &QTimer::timeout, this, &MessageView::refresh);
    timer_.start(std::chrono::milliseconds(100));
    follow(nullptr, {});
}

MessageView::~MessageView() = default;

void MessageView::follow(DaemonLink *daemon, const QString &topic) {
    if (daemon && daemon == daemon_ && topic == topic_)
        return;
    daemon_ = daemon;
    topic_ = topic;
    schema_ = daemon ? topicDescription(daemon->description(), topic)["schema"].toObject() : QJsonObject();
    tree_->clear();
    meter_.reset();
    refresh();
}

// What nobody sees costs nothing on the link.
void MessageView::refresh() {
    if (!isSeen(*this) || !daemon_)
        meter_.reset();
    else if (!meter_)
        meter_ = std::make_unique<TopicMeter>(daemon_, topic_, isHeavy(schema_) ? heavyRate_hz : rate_hz,
                                              [this](const TopicUpdate &update) { take(update); });
    showAge();
}

void MessageView::take(const TopicUpdate &update) {
    stamp_ = update.stamp;
    room_ = maxRows;
    const bool isFirst = tree_->topLevelItemCount() == 0;
    if (isFirst)
        new QTreeWidgetItem(tree_);
    QTreeWidgetItem *const root = tree_->topLevelItem(0);
    setText(*root, 0, shortLine(topic_, longestShown));
    fill(root, update.data, schema_, 0);
    root->setExpanded(isFirst || root->isExpanded());
}

void MessageView::fill(QTreeWidgetItem *item, WireView value, const QJsonObject &schema, int depth) {
    --room_;
    setText(*item, 1, textOf(value));
    const bool isNumber = value.kind() == WireView::Kind::Number;
    setText(*item, 2, isNumber ? shortLine(unitOf(schema)) : QString());
    if (const QString tip = toolTipOf(schema["description"].toString()); item->toolTip(0) != tip)
        item->setToolTip(0, tip);
    const int before = item->childCount();
    fillChildren(item, value, schema, depth);
    constexpr int maxOpened = 8; // of a list or an object
    if (before == 0 && item->childCount() > 0 && item->childCount() <= maxOpened && depth < 3)
        item->setExpanded(true);
}

void MessageView::fillChildren(QTreeWidgetItem *item, WireView value, const QJsonObject &schema, int depth) {
    std::vector<std::pair<QString, WireView>> inner;
    const std::size_t all = depth < deepestShown ? value.size() : 0;
    if (value.kind() == WireView::Kind::Array)
        for (std::size_t i = 0; i < std::min<std::size_t>(all, maxOfOne); ++i)
            inner.emplace_back(QString::number(i), value[i]);
    else if (all > 0)
        value.forEachMember([&inner](const QString &name, WireView member) {
            if (inner.size() < maxOfOne)
                inner.emplace_back(name, member);
        });
    const int count = std::min(int(inner.size()), std::max(0, room_));
    const bool isCut = all > std::size_t(count);
    for (int i = 0; i < count; ++i) {
        QTreeWidgetItem *const child = rowAt(*item, i);
        const auto &[name, member] = inner[std::size_t(i)];
        setText(*child, 0, shortLine(name, longestShown));
        fill(child, member, schemaAt(schema, name), depth + 1);
    }
    if (isCut) {
        QTreeWidgetItem *const more = rowAt(*item, count);
        qDeleteAll(more->takeChildren());
        setText(*more, 0, tr("and %1 more").arg(all - std::size_t(count)));
        setText(*more, 1, {});
        setText(*more, 2, {});
    }
    while (item->childCount() > count + int(isCut))
        delete item->takeChild(item->childCount() - 1);
}

void MessageView::showAge() {
    const bool isOld = meter_ && !meter_->freshness().isFresh();
    head_->setEnabled(!isOld); // grey
    QPalette colours;
    if (isOld)
        colours.setColor(QPalette::Text, palette().color(QPalette::Disabled, QPalette::Text));
    if (tree_->palette() != colours)
        tree_->setPalette(colours);
    if (!daemon_)
        return head_->setText(tr("Choose a topic on the left to see its newest message."));
    const QString title = tr("%1 of %2").arg(shortLine(topic_, longestShown), daemon_->name());
    if (!meter_ || meter_->text().isEmpty())
        return head_->setText(tr("%1: nothing has come as yet").arg(title));
    const auto time = timeOf(stamp_);
    const bool isToday = time && time->date() == QDate::currentDate();
    head_->setText(tr("%1: %2, stamp %3")
                       .arg(title, meter_->text(),
                            time ? time->toString(isToday ? "HH:mm:ss.zzz" : "yyyy-MM-dd HH:mm:ss.zzz")
                                 : tr("beyond any time")));
}

} // namespace hermes::desktop
