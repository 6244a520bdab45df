# SPDX-License-Identifier: Apache-2.0
"""The people there are; see person.py."""
