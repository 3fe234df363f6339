#include "gui/desktop/panels/CloudPanel.h"

#include "gui/desktop/Theme.h"
#include "gui/desktop/widgets/AgedLabel.h"

#include <QComboBox>
#include <QDockWidget>
#include <QPushButton>
#include <QVBoxLayout>

namespace hermes::desktop {

CloudPanel::CloudPanel(Fleet &fleet, QWidget *parent)
    : QWidget(parent)
    , model_(fleet)
    , view_(new CloudView(model_))
    , summary_(new AgedLabel)
    , way_(new PlainLabel) {
    view_->setObjectName("cloudView");
    view_->setAccessibleName(tr("Cloud of the lidar"));
    view_->setToolTip(tr("Left button: turn. Right or middle button: move. Wheel: zoom.\n"
                         "Home, End, Page up, Page down: turn. +, -: zoom. 0: all of it."));
    auto *const layout = new QVBoxLayout(this);
    layout->setContentsMargins(0, 0, 0, 0);
    layout->setSpacing(2);
    layout->addLayout(makeTop());
    layout->addWidget(view_, 1);
    setFocusProxy(view_);
    connect(&model_, &CloudModel::changed, this, &CloudPanel::tell);
    connect(view_, &CloudView::rendererChanged, this, [this] {
        way_->setText(view_->renderer()->isByOpenGl() ? QString() : tr("without graphics card"));
    });
    tell();
}

QLayout *CloudPanel::makeTop() {
    auto *const colour = new QComboBox;
    colour->setObjectName("cloudColour");
    colour->addItems({tr("height"), tr("intensity")});
    colour->setToolTip(tr("Height above the lidar in metres, or how much of the light came back (0 to 255)"));
    auto *const label = new PlainLabel(tr("Colour"));
    label->setBuddy(colour);
    colour->setAccessibleName(tr("Colour of the points"));
    auto *const reset = new QPushButton(theme::icon("fit"), tr("Reset view"));
    reset->setObjectName("resetCloud");
    reset->setToolTip(tr("All of the cloud, from behind the robot (0)"));
    summary_->setObjectName("cloudSummary");
    summary_->setToolTip(
        tr("Of the last turn of the lidar. The setting cloud.max_points of its logger thins it."));
    way_->setObjectName("cloudWay");
    way_->setToolTip(tr(
        "No graphics card can be used here: the processor draws the points, with fewer pictures a second"));
    auto *const top = new QHBoxLayout;
    top->setContentsMargins(6, 2, 6, 0);
    top->setSpacing(10);
    top->addWidget(label);
    top->addWidget(colour);
    top->addWidget(reset);
    top->addWidget(summary_, 1);
    top->addWidget(way_);
    connect(reset, &QPushButton::clicked, view_, &CloudView::resetView);
    connect(colour, QOverload<int>::of(&QComboBox::currentIndexChanged), view_,
            [this](int index) { view_->colourBy(CloudScene::Colouring(index)); });
    return top;
}

void CloudPanel::tell() {
    summary_->tell(model_.summary(), model_.age());
}

void CloudPanel::onSight(bool isInSight) {
    // One that is taken out of its tabs says that it is not in sight.
    const auto *const dock = qobject_cast<const QDockWidget *>(sender());
    model_.setEnabled(isInSight || (dock && dock->isFloating() && isVisible()));
}

// A tab over the panel does not hide it.
void CloudPanel::showEvent(QShowEvent *event) {
    bool isInDock = false;
    for (QWidget *above = parentWidget(); above; above = above->parentWidget())
        if (const auto *const dock = qobject_cast<QDockWidget *>(above)) {
            connect(dock, &QDockWidget::visibilityChanged, this, &CloudPanel::onSight, Qt::UniqueConnection);
            isInDock = !dock->isFloating();
        }
    if (!isInDock)
        onSight(true);
    QWidget::showEvent(event);
}

void CloudPanel::hideEvent(QHideEvent *event) {
    onSight(false);
    QWidget::hideEvent(event);
}

} // namespace hermes::desktop
