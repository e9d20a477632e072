"""Plots: a module a kind, which draws plain data on axes of matplotlib, and what they share."""
