"""The trial of model.py in numpy and in JAX: columns of given draws, and batches of trials with draws of their own."""

import model
import numpy as np


class Numpy:
    name = "numpy"

    def __init__(self, path, noise, controller):
        def over(f, groups):
            return np.stack([f(group) for group in groups])

        self.trial = model.Trial(np, over, lambda f, *given: f(*given), path, noise, controller)

    def columns(self, normals):
        state = self.trial.started(normals[0])
        for k in range(1, model.K):
            state = self.trial.step(state, normals[k], self.trial.translations[k - 1])
        return self.trial.columns(state)

    def batches(self, size):
        """A function that simulates the next `size` trials."""
        generator = np.random.Generator(np.random.SFC64(1))
        return lambda: self.columns(generator.standard_normal((model.K, model.NORMALS, size)))


class Jax:
    name = "JAX"

    def __init__(self, path, noise, controller):
        import jax
        import jax.numpy as jnp

        jax.config.update("jax_enable_x64", True)

        def apart(f, *given):
            """f(*given), behind a condition that always holds: without it XLA fuses the eliminations with all that
            follows, and computes the same rows again wherever they are used."""
            def otherwise(*given):
                return jax.tree.map(lambda like: jnp.zeros(like.shape), jax.eval_shape(f, *given))

            return jax.lax.cond(jax.tree.leaves(given)[0].ravel()[0] != -jnp.inf, f, otherwise, *given)

        trial = model.Trial(jnp, jax.lax.map, apart, path, noise, controller)

        def columns(normals):
            def step(state, now):
                return trial.step(state, *now), None

            state, _ = jax.lax.scan(step, trial.started(normals[0]), (normals[1:], trial.translations))
            return trial.columns(state)

        self.jax, self.compiled = jax, jax.jit(columns)

    def columns(self, normals):
        return np.asarray(self.compiled(normals))

    def batches(self, size):
        jax, key, count = self.jax, self.jax.random.key(1), iter(range(1 << 31))

        @jax.jit
        def batch(number):
            draws = jax.random.fold_in(key, number)
            return self.compiled(jax.random.normal(draws, (model.K, model.NORMALS, size), "float64"))

        return lambda: batch(next(count)).block_until_ready()
