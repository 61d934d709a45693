// SPDX-License-Identifier: MPL-2.0
// Nothing: the target of the headers that light tests share needs a source.
