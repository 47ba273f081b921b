"""One thread of linear algebra while birds fly, whichever thread asks for it."""

from concurrent.futures import ThreadPoolExecutor

from threadpoolctl import threadpool_info

from birdmb.threads import one_thread


def threads():
    return [each["num_threads"] for each in threadpool_info() if each["user_api"] == "blas"]


def limited():
    with one_thread():
        return set(threads()) <= {1}


def test_the_limit_is_lifted_once_the_last_has_ended():
    """Else a point that ends would give its threads back to one that goes on."""
    before = threads()
    with one_thread():
        with one_thread():
            assert set(threads()) <= {1}
        assert set(threads()) <= {1}
    assert threads() == before


def test_any_thread_sets_the_limit_after_another_did():
    assert limited()
    before = threads()
    with ThreadPoolExecutor(1) as pool:
        assert pool.submit(limited).result()
        assert pool.submit(threads).result() == before
    assert limited()
    assert threads() == before
