"""The outside world, simulated: instruments that speak real bytes, and the plant behind them."""
