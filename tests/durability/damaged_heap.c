/* A program that the C library ends because its heap is damaged, while it holds the heap's lock: it has two threads,
   and frees twice what is too large to be kept aside. */
#include <pthread.h>
#include <stdlib.h>
#include <unistd.h>

static void *idle(void *nothing) { return pause(), nothing; }

int main(void) {
    pthread_t other;
    if (pthread_create(&other, NULL, idle, NULL) != 0) return 1;
    char *volatile large = malloc(100000);
    free(large);
    free(large);
    return 0;
}
