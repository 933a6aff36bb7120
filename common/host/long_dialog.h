// MeshLab's dialog for a filter that has many parameters.
#pragma once

#include <QString>

class QDockWidget;

namespace meshcomplete {
namespace host {

/// MeshLab's dialogs show all parameters one below the other and do not scroll, so that a filter with many
/// parameters has its buttons below the screen. To be called when MeshLab asks for the parameters of the
/// filter with this name: once its dialog is shown, `fit_to_screen` is called for it. Nothing happens where
/// there is no dialog.
void fit_dialog_to_screen(const QString& filter);

/// Puts the parameters of the dialog into an area that scrolls when the dialog is higher than the screen. A
/// mouse wheel that scrolls them changes no values. A dialog that is not made like those of MeshLab 2020.09
/// stays as it is.
void fit_to_screen(QDockWidget& dialog);

}  // namespace host
}  // namespace meshcomplete
