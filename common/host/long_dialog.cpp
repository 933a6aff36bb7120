#include "common/host/long_dialog.h"

#include <QAbstractSpinBox>
#include <QApplication>
#include <QComboBox>
#include <QDockWidget>
#include <QEvent>
#include <QGridLayout>
#include <QScreen>
#include <QScrollArea>
#include <QScrollBar>
#include <QTimer>
#include <memory>

namespace meshcomplete {
namespace host {
namespace {

/// Lists and number fields change their values when the wheel turns above them, even while the page scrolls.
class WheelGuard : public QObject {
 public:
  explicit WheelGuard(QScrollArea& area) : QObject(&area), area_(area) {}
  bool eventFilter(QObject*, QEvent* event) override {
    if (event->type() != QEvent::Wheel) return false;
    QApplication::sendEvent(area_.viewport(), event);
    return true;
  }

 private:
  QScrollArea& area_;
};

/// The parameters: in MeshLab's dialog a frame below the description and above the buttons.
QFrame* parameters_of(const QDockWidget& dialog) {
  const QGridLayout* grid =
      dialog.widget() == nullptr ? nullptr : qobject_cast<QGridLayout*>(dialog.widget()->layout());
  QLayoutItem* item = grid == nullptr ? nullptr : grid->itemAtPosition(1, 0);
  return item == nullptr ? nullptr : qobject_cast<QFrame*>(item->widget());
}

QScrollArea* scrolling(QFrame& parameters) {
  auto* area = new QScrollArea(parameters.parentWidget());
  area->setWidgetResizable(true);
  area->setFrameShape(QFrame::NoFrame);
  area->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  auto* guard = new WheelGuard(*area);
  for (QComboBox* list : parameters.findChildren<QComboBox*>()) list->installEventFilter(guard);
  for (QAbstractSpinBox* field : parameters.findChildren<QAbstractSpinBox*>())
    field->installEventFilter(guard);
  return area;
}

}  // namespace

void fit_to_screen(QDockWidget& dialog) {
  QFrame* parameters = parameters_of(dialog);
  if (parameters == nullptr || qobject_cast<QScrollArea*>(parameters) != nullptr) return;
  const QRect screen = dialog.screen()->availableGeometry();
  if (dialog.frameGeometry().height() <= screen.height()) return;
  QScrollArea* area = scrolling(*parameters);
  const std::unique_ptr<QLayoutItem> replaced(dialog.widget()->layout()->replaceWidget(parameters, area));
  area->setWidget(parameters);
  area->show();
  const int title = dialog.frameGeometry().height() - dialog.height();
  dialog.setMinimumHeight(0);
  dialog.resize(dialog.width() + area->verticalScrollBar()->sizeHint().width(), screen.height() - title);
  dialog.move(dialog.x(), screen.top());
}

void fit_dialog_to_screen(const QString& filter) {
  if (qobject_cast<QApplication*>(QCoreApplication::instance()) == nullptr) return;
  QTimer::singleShot(0, qApp, [filter] {
    for (QWidget* widget : QApplication::allWidgets()) {
      auto* dialog = qobject_cast<QDockWidget*>(widget);
      if (dialog != nullptr && dialog->isVisible() && dialog->windowTitle() == filter) fit_to_screen(*dialog);
    }
  });
}

}  // namespace host
}  // namespace meshcomplete
