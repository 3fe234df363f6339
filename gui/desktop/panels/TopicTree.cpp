#include "gui/desktop/panels/TopicTree.h"

#include "gui/desktop/Theme.h"
#include "gui/desktop/widgets/ForeignText.h"
#include "gui/desktop/widgets/Seen.h"

#include <QHeaderView>
#include <QJsonArray>

namespace hermes::desktop {
namespace {

constexpr int maxTopics = 200, maxFields = 200;
constexpr std::size_t maxMeasured = 60; // of the 100 subscriptions that a daemon grants

enum Role { AddressRole = Qt::UserRole, TopicRole, PathRole, DaemonRole, DescriptionRole, HeavyRole };

DaemonLink *daemonOf(const QTreeWidgetItem &item) {
    return qobject_cast<DaemonLink *>(item.data(0, DaemonRole).value<QPointer<QObject>>());
}

FieldId fieldOf(const QTreeWidgetItem &item) {
    return {item.data(0, AddressRole).toString(), item.data(0, TopicRole).toString(),
            item.data(0, PathRole).toString()};
}

bool isTopic(const QTreeWidgetItem &item) {
    return item.parent() && !item.parent()->parent();
}

QJsonObject descriptionOf(const QTreeWidgetItem &topic) {
    return topic.data(0, DescriptionRole).toJsonObject();
}

QHash<QString, QJsonObject> topicsOf(const DaemonLink &daemon) {
    QHash<QString, QJsonObject> topics;
    for (const QJsonValue &topic : daemon.description()["x-topics"].toArray())
        topics.insert(topic["name"].toString(), topic.toObject());
    return topics;
}

} // namespace

TopicTree::TopicTree(Fleet &fleet, std::function<bool(const FieldId &)> isPlotted, QWidget *parent)
    : QTreeWidget(parent)
    , fleet_(fleet)
    , isPlotted_(std::move(isPlotted)) {
    setObjectName("topics");
    setAccessibleName(tr("Topics and their numbers"));
    setHeaderHidden(true);
    setUniformRowHeights(true);
    setColumnCount(2);
    setIndentation(14);
    if (theme::isDark()) { // the edge of an empty box is a darker window, which nobody would see there
        QPalette edges = palette();
        edges.setColor(QPalette::Window, edges.color(QPalette::Disabled, QPalette::Text).lighter(130));
        setPalette(edges);
    }
    header()->setStretchLastSection(false);
    header()->setSectionResizeMode(0, QHeaderView::Stretch);
    header()->setSectionResizeMode(1, QHeaderView::Fixed);
    header()->setMinimumSectionSize(20);
    connect(this, &QTreeWidget::itemExpanded, this, [this](QTreeWidgetItem *item) {
        if (isTopic(*item))
            open(item);
    });
    connect(this, &QTreeWidget::itemChanged, this, &TopicTree::onItemChanged);
    connect(this, &QTreeWidget::itemClicked, this,
            [this](QTreeWidgetItem *item) { setCurrentItem(item, 0); }); // where Enter ticks
    connect(this, &QTreeWidget::currentItemChanged, this, &TopicTree::topicChosen);
    connect(&fleet, &Fleet::changed, this, &TopicTree::listTopics);
    connect(&timer_, &QTimer::timeout, this, &TopicTree::measureAll);
    timer_.start(std::chrono::milliseconds(150));
    listTopics();
}

TopicTree::~TopicTree() {
    disconnect(); // rows go
}

void TopicTree::resizeEvent(QResizeEvent *event) {
    QTreeWidget::resizeEvent(event);
    const int silence = fontMetrics().horizontalAdvance("no data for 000 s") + 8;
    header()->resizeSection(1, std::min(silence, int(0.42 * viewport()->width())));
}

std::pair<DaemonLink *, QString> TopicTree::chosenTopic() const {
    const QTreeWidgetItem *const item = currentItem();
    if (!item || !item->parent())
        return {};
    return {daemonOf(*item), item->data(0, TopicRole).toString()};
}

QTreeWidgetItem *TopicTree::rowOf(DaemonLink *daemon) {
    for (int i = 0; i < topLevelItemCount(); ++i)
        if (daemonOf(*topLevelItem(i)) == daemon)
            return topLevelItem(i);
    auto *const row = new QTreeWidgetItem(this);
    row->setData(0, DaemonRole, QVariant::fromValue(QPointer<QObject>(daemon)));
    row->setToolTip(0, toolTipOf(daemon->title()));
    row->setExpanded(true);
    return row;
}

// What is listed once stays while its daemon does.
void TopicTree::listTopics() {
    isListing_ = true;
    dropGone();
    for (const auto &robot : fleet_.robots())
        for (DaemonLink *daemon : robot->daemons())
            if (!daemon->topics().isEmpty()) {
                QTreeWidgetItem *const row = rowOf(daemon);
                addTopics(row, daemon);
                const int all = daemon->topics().size();
                const QString title = fleet_.titleOf(*daemon);
                row->setText(
                    0, all <= maxTopics
                           ? title
                           : tr("%1 (%2 topics, of which %3 are listed)").arg(title).arg(all).arg(maxTopics));
            }
    isListing_ = false;
}

void TopicTree::dropGone() {
    for (int i = topLevelItemCount() - 1; i >= 0; --i) {
        if (daemonOf(*topLevelItem(i)) || !topLevelItem(i)->data(0, DaemonRole).isValid())
            continue;
        for (int j = 0; j < topLevelItem(i)->childCount(); ++j) {
            meters_.erase(topLevelItem(i)->child(j));
            opening_.erase(topLevelItem(i)->child(j));
        }
        delete takeTopLevelItem(i);
    }
}

void TopicTree::addTopics(QTreeWidgetItem *row, DaemonLink *daemon) {
    QSet<QString> listed{"log", "settings"};
    for (int i = 0; i < row->childCount(); ++i)
        listed.insert(row->child(i)->data(0, TopicRole).toString());
    QHash<QString, QJsonObject> described;
    for (const QString &topic : daemon->topics()) {
        if (listed.contains(topic) || row->childCount() >= maxTopics)
            continue;
        if (described.isEmpty())
            described = topicsOf(*daemon);
        addTopic(row, topic, described.value(topic));
    }
}

void TopicTree::addTopic(QTreeWidgetItem *row, const QString &topic, const QJsonObject &description) {
    auto *const child = new QTreeWidgetItem(row, {shortLine(topic, longestName)});
    child->setData(0, TopicRole, topic);
    child->setData(0, DaemonRole, row->data(0, DaemonRole));
    child->setData(0, DescriptionRole, description);
    child->setData(0, HeavyRole, isHeavy(description["schema"].toObject()));
    child->setChildIndicatorPolicy(QTreeWidgetItem::ShowIndicator);
    child->setToolTip(0, toolTipOf(topic + '\n' + description["summary"].toString()));
    if (plotted_[daemonOf(*row)->address()].contains(topic))
        child->setExpanded(true);
}

void TopicTree::open(QTreeWidgetItem *topic) {
    addFields(topic, numericPaths(descriptionOf(*topic)["schema"].toObject(), maxFields, UnknownLists::None));
    opening_.insert(topic); // lists are as long as those of its next message
    if (topic->childCount() == 0)
        Q_EMIT told(tr("Waiting for a message of %1 ...").arg(topic->text(0)));
    meters_.erase(topic); // a new subscription begins with a message where there is one
    measureAll();
}

void TopicTree::addFields(QTreeWidgetItem *topic, const QStringList &paths) {
    DaemonLink *const daemon = daemonOf(*topic);
    if (!daemon)
        return;
    const bool wasListing = std::exchange(isListing_, true);
    const QJsonObject schema = descriptionOf(*topic)["schema"].toObject();
    QSet<QString> listed;
    for (int i = 0; i < topic->childCount(); ++i)
        listed.insert(topic->child(i)->data(0, PathRole).toString());
    for (const QString &path : paths) {
        if (listed.contains(path) || topic->childCount() >= maxFields)
            continue;
        const QString name = path.isEmpty() ? topic->data(0, TopicRole).toString() : path;
        const QJsonObject what = schemaAt(schema, path);
        auto *const child =
            new QTreeWidgetItem(topic, {shortLine(name, longestName), shortLine(unitOf(what))});
        child->setData(0, AddressRole, daemon->address());
        child->setData(0, TopicRole, topic->data(0, TopicRole));
        child->setData(0, PathRole, path);
        child->setData(0, DaemonRole, topic->data(0, DaemonRole));
        child->setToolTip(0, toolTipOf(name + '\n' + what["description"].toString()));
        child->setCheckState(0, isPlotted_(fieldOf(*child)) ? Qt::Checked : Qt::Unchecked);
    }
    isListing_ = wasListing;
}

void TopicTree::take(QTreeWidgetItem *topic, const TopicUpdate &update) {
    if (opening_.erase(topic) == 0)
        return;
    addFields(topic, numericPaths(update.data, maxFields));
    QTimer::singleShot(0, this, &TopicTree::measureAll); // the meter may be needed no more
    Q_EMIT told(topic->childCount() == 0 ? tr("%1 has no number to plot.").arg(topic->text(0)) : QString());
}

void TopicTree::showTicks(const std::vector<FieldId> &plotted) {
    auto before = std::exchange(plotted_, {});
    for (const FieldId &field : plotted)
        plotted_[field.address].insert(field.topic);
    const bool wasListing = std::exchange(isListing_, true);
    for (QTreeWidgetItemIterator i(this); *i; ++i) {
        const DaemonLink *const daemon = daemonOf(**i);
        const QString topic = (*i)->data(0, TopicRole).toString(), address = daemon ? daemon->address() : "";
        if ((*i)->data(0, PathRole).isValid())
            (*i)->setCheckState(0, isPlotted_(fieldOf(**i)) ? Qt::Checked : Qt::Unchecked);
        else if (plotted_[address].contains(topic) && !before[address].contains(topic))
            (*i)->setExpanded(true);
    }
    isListing_ = wasListing;
}

void TopicTree::onItemChanged(QTreeWidgetItem *item) {
    if (!isListing_ && item->data(0, PathRole).isValid())
        Q_EMIT ticked(fieldOf(*item), item->checkState(0) == Qt::Checked);
}

// What nobody sees costs nothing on the link; a topic that may be large and begins with all of it is only
// measured where somebody looks at it.
bool TopicTree::isMeasured(QTreeWidgetItem *topic) const {
    if (!daemonOf(*topic) || opening_.count(topic))
        return daemonOf(*topic);
    const bool isLookedAt = topic->isExpanded() || topic == currentItem();
    if (!isSeen_ || !topic->parent()->isExpanded())
        return false;
    if (!isLookedAt && !viewport()->rect().intersects(visualItemRect(topic)))
        return meters_.count(topic) > 0; // scrolling does not end it
    return isLookedAt || !topic->data(0, HeavyRole).toBool() || !descriptionOf(*topic)["snapshot"].toBool();
}

void TopicTree::measureAll() {
    isSeen_ = isSeen(*this);
    const bool wasListing = std::exchange(isListing_, true);
    for (int i = 0; i < topLevelItemCount(); ++i)
        for (int j = 0; j < topLevelItem(i)->childCount(); ++j)
            measure(topLevelItem(i)->child(j));
    isListing_ = wasListing;
}

void TopicTree::measure(QTreeWidgetItem *topic) {
    const auto found = meters_.find(topic);
    if (!isMeasured(topic) || (found == meters_.end() && meters_.size() >= maxMeasured)) {
        meters_.erase(topic);
        return topic->setText(1, {});
    }
    if (found == meters_.end()) {
        const bool isHeavyOne = topic->data(0, HeavyRole).toBool();
        meters_.emplace(
            topic, std::make_unique<TopicMeter>(daemonOf(*topic), topic->data(0, TopicRole).toString(),
                                                isHeavyOne ? TopicMeter::heavyRate_hz : TopicMeter::rate_hz,
                                                [this, topic](const auto &update) { take(topic, update); }));
        return;
    }
    const TopicMeter &meter = *found->second;
    topic->setText(1, meter.text());
    const QBrush colour =
        meter.freshness().isFresh() ? QBrush() : palette().brush(QPalette::Disabled, QPalette::Text);
    if (topic->foreground(1) != colour)
        topic->setForeground(1, colour);
}

} // namespace hermes::desktop
