"""The model: rigs, fibre models, friction laws, kernels, score, fit, diagnosis, report."""
