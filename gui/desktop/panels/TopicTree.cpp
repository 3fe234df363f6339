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

/// Of a daemon, of a topic of it, or of a number in that.
struct TopicRow : QTreeWidgetItem {
    using QTreeWidgetItem::QTreeWidgetItem;
    QPointer<DaemonLink> daemon;
    QString topic;
    QJsonObject description; ///< of a topic
    bool isHeavy = false;
    std::optional<FieldId> field; ///< of a number
};

/// Of an item that somebody else has put into the tree: an empty one.
TopicRow &rowIn(QTreeWidgetItem &item) {
    static TopicRow none;
    auto *const row = dynamic_cast<TopicRow *>(&item);
    return row ? *row : none;
}

bool isTopic(const QTreeWidgetItem &item) {
    return item.parent() && !item.parent()->parent();
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
    QTreeWidgetItem *const item = currentItem();
    if (!item || !item->parent())
        return {};
    return {rowIn(*item).daemon, rowIn(*item).topic};
}

QTreeWidgetItem *TopicTree::rowOf(DaemonLink *daemon) {
    for (int i = 0; i < topLevelItemCount(); ++i)
        if (rowIn(*topLevelItem(i)).daemon == daemon)
            return topLevelItem(i);
    auto *const row = new TopicRow(this);
    row->daemon = daemon;
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
        if (rowIn(*topLevelItem(i)).daemon)
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
        listed.insert(rowIn(*row->child(i)).topic);
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
    auto *const child = new TopicRow(row, {shortLine(topic, longestName)});
    child->topic = topic;
    child->daemon = rowIn(*row).daemon;
    child->description = description;
    child->isHeavy = isHeavy(description["schema"].toObject());
    child->setChildIndicatorPolicy(QTreeWidgetItem::ShowIndicator);
    child->setToolTip(0, toolTipOf(topic + '\n' + description["summary"].toString()));
    if (plotted_[child->daemon->address()].contains(topic))
        child->setExpanded(true);
}

void TopicTree::open(QTreeWidgetItem *topic) {
    addFields(topic,
              numericPaths(rowIn(*topic).description["schema"].toObject(), maxFields, UnknownLists::None));
    opening_.insert(topic); // lists are as long as those of its next message
    if (topic->childCount() == 0)
        Q_EMIT told(tr("Waiting for a message of %1 ...").arg(topic->text(0)));
    meters_.erase(topic); // a new subscription begins with a message where there is one
    measureAll();
}

void TopicTree::addFields(QTreeWidgetItem *topic, const QStringList &paths) {
    const TopicRow &of = rowIn(*topic);
    if (!of.daemon)
        return;
    const bool wasListing = std::exchange(isListing_, true);
    const QJsonObject schema = rowIn(*topic).description["schema"].toObject();
    QSet<QString> listed;
    for (int i = 0; i < topic->childCount(); ++i)
        listed.insert(rowIn(*topic->child(i)).field->path);
    for (const QString &path : paths) {
        if (listed.contains(path) || topic->childCount() >= maxFields)
            continue;
        const QString name = path.isEmpty() ? of.topic : path;
        const QJsonObject what = schemaAt(schema, path);
        auto *const child = new TopicRow(topic, {shortLine(name, longestName), shortLine(unitOf(what))});
        child->daemon = of.daemon;
        child->topic = of.topic;
        child->field = {of.daemon->address(), of.topic, path};
        child->setToolTip(0, toolTipOf(name + '\n' + what["description"].toString()));
        child->setCheckState(0, isPlotted_(*child->field) ? Qt::Checked : Qt::Unchecked);
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
        TopicRow &row = rowIn(**i);
        const QString address = row.daemon ? row.daemon->address() : QString();
        if (row.field)
            row.setCheckState(0, isPlotted_(*row.field) ? Qt::Checked : Qt::Unchecked);
        else if (plotted_[address].contains(row.topic) && !before[address].contains(row.topic))
            row.setExpanded(true);
    }
    isListing_ = wasListing;
}

void TopicTree::onItemChanged(QTreeWidgetItem *item) {
    if (!isListing_ && rowIn(*item).field)
        Q_EMIT ticked(*rowIn(*item).field, item->checkState(0) == Qt::Checked);
}

// What nobody sees costs nothing on the link; a topic that may be large and begins with all of it is only
// measured where somebody looks at it.
bool TopicTree::isMeasured(QTreeWidgetItem *topic) const {
    if (!rowIn(*topic).daemon || opening_.count(topic))
        return rowIn(*topic).daemon;
    const bool isLookedAt = topic->isExpanded() || topic == currentItem();
    if (!isSeen_ || !topic->parent()->isExpanded())
        return false;
    if (!isLookedAt && !viewport()->rect().intersects(visualItemRect(topic)))
        return meters_.count(topic) > 0; // scrolling does not end it
    return isLookedAt || !rowIn(*topic).isHeavy || !rowIn(*topic).description["snapshot"].toBool();
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
        const TopicRow &row = rowIn(*topic);
        meters_.emplace(
            topic, std::make_unique<TopicMeter>(row.daemon, row.topic,
                                                row.isHeavy ? TopicMeter::heavyRate_hz : TopicMeter::rate_hz,
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
